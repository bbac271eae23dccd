#include "framework/estimation/ridges/identified_combinations.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <set>

#include "framework/base/text/nearest_name.hpp"
#include "framework/estimation/levels.hpp"
#include "framework/estimation/ridges/candidates.hpp"
#include "framework/estimation/ridges/local_sums.hpp"
#include "framework/experiment/model/parameter_box.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// How well a function fits: exact flat directions leave rounding; weak ones are directions of little
/// information, which products and sums describe to some percent.
constexpr std::array<double, 3> kResiduals{kExact, 1e-2, 5e-2};

/// The functions that were chosen, by their gradients at every point.
class ChosenFunctions {
 public:
  ChosenFunctions(const FlatDirections& flat, const std::vector<ParameterSpec>& parameters)
      : flat_(flat), widths_(calcWidths(parameters)), bases_(flat.changes.size()) {}

  /// Whether a gradient has a part on average that those of the chosen do not span. It is to be twice what
  /// functions that fit within `largest` may be off by, and a hundredth.
  bool isIndependent(const Combination& combination, double largest) const {
    constexpr double kTwice = 2.0, kLeast = 0.01;
    double rest = 0.0;
    for (std::size_t i = 0; i < bases_.size(); ++i) {
      rest += project(combination, i).norm();
    }
    return rest > std::max(kTwice * largest, kLeast) * static_cast<double>(bases_.size());
  }

  void add(const Combination& combination) {
    for (std::size_t i = 0; i < bases_.size(); ++i) {
      bases_[i].push_back(project(combination, i).normalized());
    }
  }

 private:
  /// The unit gradient at a point less its part in the span of the chosen.
  VectorXd project(const Combination& combination, std::size_t i) const {
    VectorXd rest = calcGradient(combination, flat_.points.col(static_cast<Index>(i)))
                        .cwiseProduct(widths_)(flat_.parameters)
                        .normalized();
    for (const VectorXd& direction : bases_[i]) {
      rest -= direction * direction.dot(rest);
    }
    return rest;
  }

  const FlatDirections& flat_;
  VectorXd widths_;
  std::vector<std::vector<VectorXd>> bases_;
};

/// The simplest candidates first; of equally simple ones the better.
void sortBySimplicity(std::vector<Candidate>& candidates) {
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.complexity < b.complexity; });
}

/// Takes of the candidates within the residual those that are independent and, where `holds` is asked, hold,
/// until so many are chosen.
void choose(const std::vector<Candidate>& candidates, double largest, std::size_t count,
            const std::function<bool(const Combination&)>& holds, ChosenFunctions& chosen,
            std::vector<Combination>& combinations) {
  for (const Candidate& candidate : candidates) {
    if (combinations.size() < count && candidate.combination.residual <= largest &&
        chosen.isIndependent(candidate.combination, largest) && holds(candidate.combination)) {
      chosen.add(candidate.combination);
      combinations.push_back(candidate.combination);
    }
  }
}

std::vector<Combination> nameCombinations(const FlatDirections& flat,
                                          const std::vector<ParameterSpec>& parameters, RidgePoints of) {
  const auto count = static_cast<std::size_t>(static_cast<Index>(flat.parameters.size()) - flat.dimension);
  std::vector<Candidate> simple = findProducts(flat, parameters, kResiduals.back());
  const std::vector<Candidate> sums = findSums(flat, parameters, kResiduals.back());
  simple.insert(simple.end(), sums.begin(), sums.end());
  sortBySimplicity(simple);
  ChosenFunctions chosen(flat, parameters);
  std::vector<Combination> combinations;
  for (const double largest : kResiduals) {
    const auto holds = [&](const Combination& combination) {
      return of == RidgePoints::kOfAny || largest == kResiduals.front() ||
             isConstant(combination, flat, parameters);
    };
    choose(simple, largest, count, holds, chosen, combinations);
    if (combinations.size() < count) {
      std::vector<Candidate> bases = findBaseParameters(flat, parameters, largest);
      sortBySimplicity(bases);
      choose(bases, largest, count, holds, chosen, combinations);
    }
  }
  return combinations;
}

std::string listExpressions(const std::vector<Combination>& combinations,
                            const std::vector<ParameterSpec>& parameters) {
  std::vector<std::string> expressions;
  for (const Combination& combination : combinations) {
    const std::string constants = describeConstants(combination, parameters);
    expressions.push_back(makeExpression(combination, parameters) +
                          (constants.empty() ? "" : " (" + constants + ")"));
  }
  return listNames(expressions);
}

/// "{value: m * L, unit: kg m}"
std::string makeFlowMap(const DerivedEntry& entry) {
  return "{value: " + entry.expression + (entry.unit.empty() ? "" : ", unit: " + entry.unit) + "}";
}

std::string nameBase(std::size_t sum) {
  return "base_" + std::to_string(1 + sum);
}

std::string describeBase(const Ridge& ridge) {
  std::string text = fmt::format(
      "the features determine base parameters (of bodies m, m times the centre, and the tensor about the "
      "origin "
      "of the frame), {} of which are not single parameters:",
      ridge.base.sums.size());
  for (std::size_t k = 0; k < ridge.base.sums.size(); ++k) {
    text += "\n    " + nameBase(k) + " = " + ridge.base.describe(k);
  }
  return text;
}

/// Whether one of the gradients (q x p) at the point is, in widths, that of the combination or of a function
/// of it.
bool isAmong(const Combination& combination, const MatrixXd& gradients, const VectorXd& point,
             const VectorXd& widths) {
  if (gradients.rows() == 0) {
    return false;  // nothing is derived, and there may be no point
  }
  const VectorXd own = calcGradient(combination, point).cwiseProduct(widths).normalized();
  for (Index q = 0; q < gradients.rows(); ++q) {
    const VectorXd other = widths.cwiseProduct(gradients.row(q).transpose());
    if (std::abs(own.dot(other)) > (1.0 - kSameNumber) * other.norm()) {
      return true;
    }
  }
  return false;
}

}  // namespace

std::vector<Ridge> nameRidges(const std::vector<FlatDirections>& flat,
                              const std::vector<ParameterSpec>& parameters, RidgePoints of) {
  std::vector<Ridge> ridges;
  for (const FlatDirections& one : flat) {
    ridges.push_back({one.parameters, one.dimension, {}});
    Ridge& ridge = ridges.back();
    const auto determined =
        static_cast<std::size_t>(static_cast<Index>(one.parameters.size()) - one.dimension);
    if (determined > 0) {
      ridge.combinations = nameCombinations(one, parameters, of);
    }
    if (of == RidgePoints::kOfOneMeasurement && ridge.combinations.size() < determined) {
      ridge.local = findLocalSums(one, ridge.combinations, parameters);
    }
  }
  return ridges;
}

std::vector<Ridge> findRidges(const std::vector<MatrixXd>& information, const MatrixXd& points,
                              const std::vector<ParameterSpec>& parameters, RidgePoints of) {
  std::vector<MatrixXd> looked_at;
  std::vector<Index> places;
  for (std::size_t i = 0; i < information.size() && looked_at.size() < kStandingDraws; ++i) {
    if (information[i].size() > 0) {
      looked_at.push_back(information[i]);
      places.push_back(static_cast<Index>(i));
    }
  }
  return nameRidges(findFlatDirections(looked_at, points(Eigen::all, places)), parameters, of);
}

bool hasManyForNames(const ModelSpec& model) {
  constexpr std::size_t kMost = 16, kMostOfAny = 64;  // hours, where all pairs of terms are tried
  const std::size_t count = model.parameters.size();
  return count > kMostOfAny || (count > kMost && hasInertialParameters(model));
}

std::vector<Ridge> findRidges(const std::vector<MatrixXd>& information, const MatrixXd& points,
                              const ModelSpec& model, RidgePoints of) {
  if (!hasManyForNames(model)) {
    return findRidges(information, points, model.parameters, of);
  }
  const auto there = std::find_if(information.begin(), information.end(),
                                  [](const MatrixXd& one) { return one.size() > 0; });
  if (there == information.end()) {
    return {};
  }
  Ridge ridge;
  ridge.base = findStandardSums(*there, points.col(there - information.begin()), model);
  if (ridge.base.sums.empty()) {
    return {};
  }
  ridge.parameters = ridge.base.parameters;
  ridge.dimension = ridge.base.undetermined;
  return {ridge};
}

std::string listParameters(const Ridge& ridge, const std::vector<ParameterSpec>& parameters) {
  std::vector<std::string> names;
  for (const Index j : ridge.parameters) {
    names.push_back(parameters[static_cast<std::size_t>(j)].name.text);
  }
  return listNames(names);
}

std::string describeRidge(const Ridge& ridge, const std::vector<ParameterSpec>& parameters) {
  if (!ridge.base.sums.empty()) {
    return describeBase(ridge);
  }
  const std::string names = listParameters(ridge, parameters);
  const std::string local =
      ridge.local.empty() ? "" : " near the best fit only " + listExpressions(ridge.local, parameters);
  if (ridge.combinations.empty()) {
    return fmt::format("the features do not determine {} one by one, and no simple combination of them {}",
                       names, local.empty() ? "is known" : "holds wherever they fit:" + local);
  }
  const bool all =
      static_cast<Index>(ridge.combinations.size() + static_cast<std::size_t>(ridge.dimension)) ==
      static_cast<Index>(ridge.parameters.size());
  return fmt::format("of {} the features determine {}{}{}", names, all ? "only " : "",
                     listExpressions(ridge.combinations, parameters), local.empty() ? "" : ";" + local);
}

std::vector<DerivedEntry> listDerived(const std::vector<Ridge>& ridges,
                                      const std::vector<ParameterSpec>& parameters) {
  std::vector<DerivedEntry> entries;
  std::set<std::string> taken;
  for (const Ridge& ridge : ridges) {
    for (const Combination& combination : ridge.combinations) {
      const std::string base = makeName(combination, parameters);
      std::string name = base;
      for (int number = 2; !taken.insert(name).second; ++number) {
        name = base + "_" + std::to_string(number);
      }
      entries.push_back({name,
                         makeExpression(combination, parameters),
                         findUnit(combination, parameters),
                         combination.residual,
                         {}});
    }
    for (std::size_t k = 0; k < ridge.base.sums.size(); ++k) {
      entries.push_back({nameBase(k), ridge.base.makeExpression(k), ridge.base.getUnit(k), 0.0, {}});
      for (const auto& [place, coefficient] : ridge.base.sums[k].terms) {
        entries.back().terms.emplace_back(ridge.base.standard.labels[static_cast<std::size_t>(place)],
                                          coefficient);
      }
    }
  }
  return entries;
}

std::string makeDerivedYaml(const std::vector<Ridge>& ridges, const std::vector<ParameterSpec>& parameters) {
  std::string text;
  for (const DerivedEntry& entry : listDerived(ridges, parameters)) {
    text += fmt::format("  {}: {}\n", entry.name, makeFlowMap(entry));
  }
  return text.empty() ? "" : "derived:\n" + text;
}

std::vector<std::string> adviseOnRidges(const std::vector<Ridge>& ridges,
                                        const std::vector<ParameterSpec>& parameters,
                                        const DerivedQuantities* derived, const VectorXd& point) {
  const MatrixXd gradients = derived != nullptr && point.size() == derived->countParameters()
                                 ? derived->calcGradients(point)
                                 : MatrixXd();
  std::vector<std::string> sentences;
  for (const Ridge& ridge : ridges) {
    Ridge asked = ridge;
    asked.combinations.clear();
    std::copy_if(
        ridge.combinations.begin(), ridge.combinations.end(), std::back_inserter(asked.combinations),
        [&](const Combination& one) { return !isAmong(one, gradients, point, calcWidths(parameters)); });
    std::string entries;
    for (const DerivedEntry& entry : listDerived({asked}, parameters)) {
      entries += (entries.empty() ? "" : ", ") + entry.name + ": " + makeFlowMap(entry);
    }
    sentences.push_back(describeRidge(ridge, parameters) +
                        (entries.empty() ? "" : "; reported with 'derived: {" + entries + "}'"));
  }
  return sentences;
}

}  // namespace twinmap
