#include "framework/estimation/ridges/base_parameters.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "framework/base/text/number_text.hpp"
#include "framework/estimation/levels.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// A standard term that may be taken.
struct Wish {
  std::string label, expression, unit;
};

/// Parameters, and the constants that follow from them.
std::set<std::string> listKnown(const ModelSpec& model) {
  std::set<std::string> known;
  for (const ParameterSpec& parameter : model.parameters) {
    known.insert(parameter.name.text);
  }
  for (const ConstantSpec& constant : model.constants) {
    const std::vector<std::string> used = getUsedNames(constant.value);
    if (std::all_of(used.begin(), used.end(),
                    [&](const std::string& name) { return known.count(name) > 0; })) {
      known.insert(constant.name.text);
    }
  }
  return known;
}

std::string enclose(const Expression& expression) {
  return "(" + (expression.text.empty() ? "0" : expression.text) + ")";
}

/// The ten numbers of a body: the expressions of tensors are about the centre of mass.
std::vector<Wish> listNumbers(const BodySpec& body) {
  const std::string m = enclose(body.mass), label = body.name.text + ".";
  const std::string c[] = {enclose(body.center_of_mass[0]), enclose(body.center_of_mass[1]),
                           enclose(body.center_of_mass[2])};
  const Expression3 moments = getMoments(body.inertia);
  const char* const axes[] = {"x", "y", "z"};
  std::vector<Wish> numbers{{label + "m", m, "kg"}};
  for (int i = 0; i < 3; ++i) {
    numbers.push_back({label + "m" + axes[i], m + "*" + c[i], "kg m"});
  }
  for (int i = 0; i < 3; ++i) {
    const std::string &a = c[(i + 1) % 3], &b = c[(i + 2) % 3];
    numbers.push_back(
        {label + "I" + axes[i] + axes[i],
         enclose(moments[static_cast<std::size_t>(i)]) + " + " + m + "*(" + a + "^2 + " + b + "^2)",
         "kg m2"});
  }
  for (int i = 0, k = 0; i < 3; ++i) {
    for (int j = i + 1; j < 3; ++j, ++k) {
      numbers.push_back(
          {label + "I" + axes[i] + axes[j],
           enclose(body.inertia.products[static_cast<std::size_t>(k)]) + " - " + m + "*" + c[i] + "*" + c[j],
           "kg m2"});
    }
  }
  return numbers;
}

/// Those of bodies, whose names are all known, then the parameters.
std::vector<Wish> listWishes(const ModelSpec& model) {
  const std::set<std::string> known = listKnown(model);
  std::vector<Wish> wishes;
  for (const BodySpec& body : model.system.bodies) {
    for (const Wish& number : listNumbers(body)) {
      const std::vector<std::string> used = getUsedNames({number.expression, {}});
      const bool all_known = std::all_of(used.begin(), used.end(),
                                         [&](const std::string& name) { return known.count(name) > 0; });
      if (all_known && !used.empty()) {
        wishes.push_back(number);
      }
    }
  }
  for (const ParameterSpec& parameter : model.parameters) {
    wishes.push_back({parameter.name.text, parameter.name.text, parameter.unit});
  }
  return wishes;
}

std::shared_ptr<const DerivedQuantities> makeQuantities(const ModelSpec& model,
                                                        const std::vector<Wish>& wishes) {
  ExperimentSpec experiment;
  experiment.model.parameters = model.parameters;
  experiment.model.constants = model.constants;
  for (std::size_t k = 0; k < wishes.size(); ++k) {
    experiment.derived.push_back(
        {{"standard." + std::to_string(k), {}}, {wishes[k].expression, {}}, wishes[k].unit, ""});
  }
  return std::make_shared<const DerivedQuantities>(experiment);
}

/// The first of the columns that are independent of those before them.
std::vector<std::size_t> pickIndependent(const MatrixXd& columns) {
  constexpr double kIndependent = 1e-3;  // of a unit column, so that the inverse keeps half of the digits
  MatrixXd basis(columns.rows(), 0);
  std::vector<std::size_t> picked;
  for (Index k = 0; k < columns.cols() && basis.cols() < columns.rows(); ++k) {
    if (columns.col(k).squaredNorm() == 0.0) {
      continue;
    }
    VectorXd rest = columns.col(k).normalized();
    for (int twice = 0; twice < 2; ++twice) {
      rest -= basis * (basis.transpose() * rest);
    }
    if (rest.norm() > kIndependent) {
      basis.conservativeResize(Eigen::NoChange, basis.cols() + 1);
      basis.rightCols(1) = rest.normalized();
      picked.push_back(static_cast<std::size_t>(k));
    }
  }
  return picked;
}

/// The information about the terms, from that about the parameters (p x p) and the terms' gradients (p x p).
MatrixXd turnInformation(const MatrixXd& information, const MatrixXd& gradients) {
  const Index p = information.rows();
  MatrixXd parameters_by_terms(p, p);
  for (Index k = 0; k < p; ++k) {
    parameters_by_terms.col(k) = linalg::solveLinear(gradients.transpose(), VectorXd::Unit(p, k));
  }
  return parameters_by_terms.transpose() * information * parameters_by_terms;
}

/// Places of terms that are determined, the best first: each that has information left where those before it
/// are known. A Cholesky factorisation with pivots.
std::vector<Index> pickDetermined(MatrixXd left) {
  constexpr double kSeen = 0.01 * kUniformInformation;  // the sd of the bounds becomes less by half a percent
  std::vector<Index> picked;
  for (Index count = 0; count < left.rows(); ++count) {
    Index best = 0;
    if (!(left.diagonal().maxCoeff(&best) > kSeen)) {
      break;
    }
    picked.push_back(best);
    const VectorXd column = left.col(best) / std::sqrt(left(best, best));
    left -= column * column.transpose();
    left.row(best).setZero();
    left.col(best).setZero();
  }
  return picked;
}

/// Sums of the determined terms with what the others add to them. sizes: of the terms' gradients.
std::vector<BaseParameter> makeSums(const MatrixXd& information, const std::vector<Index>& determined,
                                    const VectorXd& sizes) {
  // half of the bounds of a term that is named moves the sum
  const MatrixXd own = information(determined, determined);
  MatrixXd covariance(own.rows(), own.cols());
  for (Index k = 0; k < own.cols(); ++k) {
    covariance.col(k) = linalg::solvePositiveDefinite(own, VectorXd::Unit(own.rows(), k));
  }
  const MatrixXd added = covariance * information(determined, Eigen::all);
  std::vector<BaseParameter> sums;
  for (Index b = 0; b < own.rows(); ++b) {
    const Index first = determined[static_cast<std::size_t>(b)];
    BaseParameter sum{{{first, 1.0}}};
    for (Index k = 0; k < information.cols(); ++k) {
      const bool is_determined = std::find(determined.begin(), determined.end(), k) != determined.end();
      if (!is_determined && 0.5 * std::abs(added(b, k)) > kImmaterial * std::sqrt(covariance(b, b))) {
        sum.terms.emplace_back(k, added(b, k) * sizes[first] / sizes[k]);
      }
    }
    sums.push_back(std::move(sum));
  }
  return sums;
}

StandardTerms makeTerms(const ModelSpec& model, const std::vector<Wish>& wishes) {
  StandardTerms terms;
  for (const Wish& wish : wishes) {
    terms.labels.push_back(wish.label);
    terms.expressions.push_back(wish.expression);
    terms.units.push_back(wish.unit);
  }
  terms.quantities = makeQuantities(model, wishes);
  return terms;
}

/// Takes out the sums that are a parameter alone.
void dropParameters(const ModelSpec& model, BaseParameters& base) {
  std::vector<BaseParameter> kept;
  for (BaseParameter& sum : base.sums) {
    const auto first = static_cast<std::size_t>(sum.terms.front().first);
    const std::string& label = base.standard.labels[first];
    if (sum.terms.size() > 1 || label != base.standard.expressions[first]) {
      kept.push_back(std::move(sum));
      continue;
    }
    base.parameters.erase(
        std::remove_if(
            base.parameters.begin(), base.parameters.end(),
            [&](Index j) { return model.parameters[static_cast<std::size_t>(j)].name.text == label; }),
        base.parameters.end());
  }
  base.sums = std::move(kept);
}

std::string join(const BaseParameter& sum, const std::vector<std::string>& texts, int digits, bool enclosed) {
  std::string text;
  for (const auto& [place, coefficient] : sum.terms) {
    const std::string& term = texts[static_cast<std::size_t>(place)];
    const double size = std::abs(coefficient);
    text += coefficient < 0.0 ? (text.empty() ? "-" : " - ") : (text.empty() ? "" : " + ");
    text += (size == 1.0 ? "" : toShortText(size, digits) + " * ") + (enclosed ? "(" + term + ")" : term);
  }
  return text;
}

}  // namespace

VectorXd BaseParameters::calc(const VectorXd& point) const {
  const VectorXd values = standard.quantities->calc(point);
  VectorXd all = VectorXd::Zero(static_cast<Index>(sums.size()));
  for (std::size_t b = 0; b < sums.size(); ++b) {
    for (const auto& [place, coefficient] : sums[b].terms) {
      all[static_cast<Index>(b)] += coefficient * values[place];
    }
  }
  return all;
}

std::string BaseParameters::describe(std::size_t sum) const {
  return join(sums[sum], standard.labels, kFigureDigits, false);
}

std::string BaseParameters::makeExpression(std::size_t sum) const {
  constexpr int kDigits = 9;  // more than are determined
  return join(sums[sum], standard.expressions, kDigits, true);
}

const std::string& BaseParameters::getUnit(std::size_t sum) const {
  return standard.units[static_cast<std::size_t>(sums[sum].terms.front().first)];
}

bool hasInertialParameters(const ModelSpec& model) {
  return listWishes(model).size() > model.parameters.size();
}

BaseParameters findStandardSums(const MatrixXd& information, const VectorXd& point, const ModelSpec& model) {
  const std::vector<Wish> wishes = listWishes(model);
  const VectorXd widths = calcWidths(model.parameters);
  const MatrixXd all = widths.asDiagonal() * makeQuantities(model, wishes)->calcGradients(point).transpose();
  const std::vector<std::size_t> picked = pickIndependent(all);
  if (static_cast<Index>(picked.size()) < information.rows()) {
    return {};
  }
  std::vector<Wish> taken;
  for (const std::size_t k : picked) {
    taken.push_back(wishes[k]);
  }
  const MatrixXd gradients = all(Eigen::all, picked);
  const VectorXd sizes = gradients.colwise().norm();
  const MatrixXd turned = turnInformation(information, gradients * sizes.cwiseInverse().asDiagonal());
  const std::vector<Index> determined = pickDetermined(turned);
  if (determined.empty() || static_cast<Index>(determined.size()) == information.rows()) {
    return {};
  }
  BaseParameters base{makeTerms(model, taken), makeSums(turned, determined, sizes)};
  base.undetermined = information.rows() - static_cast<Index>(determined.size());
  for (Index j = 0; j < information.rows(); ++j) {
    base.parameters.push_back(j);
  }
  dropParameters(model, base);
  return base;
}

}  // namespace twinmap
