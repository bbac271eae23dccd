#include "framework/experiment/trust_power.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <memory>

#include "framework/design/random.hpp"
#include "framework/features/noise_whitener.hpp"
#include "framework/model_source/make_simulator.hpp"
#include "framework/refinement/acceptance.hpp"
#include "framework/results/escape.hpp"
#include "framework/sensitivity/feature_sensitivities.hpp"
#include "framework/spec/parameter_box.hpp"
#include "framework/spec/yaml/number_text.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index kPoints = 10;              // test samples: power differs over the box
constexpr Index kDraws = 200;              // of all points: they tell a share of 95 % to 1.5 %
constexpr double kDifferencesShare = 0.2;  // of the run's simulations, where derivatives are differences
constexpr double kConstantSpan = 0.2;      // relative; the interval of a constant that is made a parameter
constexpr double kLargestChange = 0.5;     // of a constant
constexpr double kFound = 0.95, kHardlyFound = 0.5;

/// The constants whose values are numbers other than zero; of a model from elsewhere those that it knows.
std::vector<ParameterSpec> listConstants(const ModelSpec& model) {
  std::vector<ParameterSpec> constants;
  for (const ConstantSpec& constant : model.constants) {
    char* end = nullptr;
    const double value = std::strtod(constant.value.text.c_str(), &end);
    const bool is_used = !model.source || constant.variable;
    if (*end == '\0' && std::abs(value) > 0.0 && is_used) {
      ParameterSpec parameter;
      parameter.name = constant.name;
      parameter.variable = constant.variable;
      parameter.unit = constant.unit;
      const double span = kConstantSpan * std::abs(value);
      parameter.bounds = {value - span, value + span, constant.value.where};
      constants.push_back(parameter);
    }
  }
  return constants;
}

/// The model in which these constants are unknown parameters, behind all others.
ModelSpec makeConstantsUnknown(ModelSpec model, const std::vector<ParameterSpec>& constants) {
  const auto is_chosen = [&](const ConstantSpec& constant) {
    return std::any_of(constants.begin(), constants.end(),
                       [&](const ParameterSpec& one) { return one.name.text == constant.name.text; });
  };
  model.constants.erase(std::remove_if(model.constants.begin(), model.constants.end(), is_chosen),
                        model.constants.end());
  model.nuisance.insert(model.nuisance.end(), constants.begin(), constants.end());
  return model;
}

/// kPoints, or as many as their simulations may cost beside the run's own, where a point takes 2 p + 1 of
/// them.
Index countPoints(const Simulator& simulator, std::size_t parameters, const SimulatedSets& sets) {
  if (simulator.hasDerivatives()) {
    return kPoints;
  }
  const auto own = static_cast<double>(sets.train.parameters.cols() + sets.test.parameters.cols());
  const auto affordable =
      static_cast<Index>(kDifferencesShare * own / (2.0 * static_cast<double>(parameters) + 1.0));
  return std::clamp<Index>(affordable, 1, kPoints);
}

/// The first `limit` test samples as points of that model's box.
MatrixXd makePoints(const ExperimentSpec& experiment, const SimulatedSets& sets,
                    const std::vector<ParameterSpec>& constants, Index limit) {
  std::vector<int> samples = findSuccessful(sets.test);
  samples.resize(std::min(samples.size(), static_cast<std::size_t>(limit)));
  const MatrixXd points = sets.test.parameters(Eigen::all, samples);
  const auto unknown = static_cast<Index>(collectUnknown(experiment.model).size());
  const auto count = static_cast<Index>(constants.size());
  MatrixXd extended(points.rows() + count, points.cols());
  extended.topRows(unknown) = points.topRows(unknown);
  extended.middleRows(unknown, count).colwise() = calcBoxCenter(constants);
  extended.bottomRows(points.rows() - unknown) = points.bottomRows(points.rows() - unknown);
  return extended;
}

/// A test sample around which the features are linear.
struct Neighbourhood {
  VectorXd features, known;
  MatrixXd sensitivities;  // d x u, per half-width of the unknown parameters
  MatrixXd slopes;         // d x c, per relative change of the constants
  VectorXd response;
};

std::vector<Neighbourhood> simulateNeighbourhoods(const PowerContext& context,
                                                  const std::vector<ParameterSpec>& constants) {
  const ModelSpec model = makeConstantsUnknown(context.experiment.model, constants);
  const ResponseLayout& layout = context.sets.test.layout;
  const std::unique_ptr<Simulator> simulator = makeSimulator(model, layout.times, layout.modes);
  const std::vector<ParameterSpec> unknown_parameters = collectUnknown(model);
  const MatrixXd points = makePoints(context.experiment, context.sets, constants,
                                     countPoints(*simulator, unknown_parameters.size(), context.sets));
  const auto count = static_cast<Index>(constants.size());
  std::vector<Neighbourhood> found;
  Index column = 0;
  for (const LocalModel& local :
       calcLocalModels(*simulator, context.extractor, unknown_parameters, points, context.threads)) {
    if (local.status.ok) {
      const Index unknown = local.sensitivities.cols() - count;
      found.push_back({local.features,
                       points.col(column).tail(static_cast<Index>(context.experiment.model.inputs.size())),
                       0.5 * local.sensitivities.leftCols(unknown),
                       local.sensitivities.rightCols(count) / (2.0 * kConstantSpan), local.response});
    }
    ++column;
  }
  return found;
}

/// What parameters take up of whitened residuals: J (J'J + prior)^-1 J', J per half-width.
class Absorption {
 public:
  explicit Absorption(MatrixXd jacobian) : jacobian_(std::move(jacobian)) {
    hessian_ = jacobian_.transpose() * jacobian_;
    hessian_.diagonal().array() += kHalfWidthInformation;
  }

  VectorXd remove(const VectorXd& residual) const {
    return residual - jacobian_ * linalg::solvePositiveDefinite(hessian_, jacobian_.transpose() * residual);
  }

  /// Residuals less what is determined of the parameters.
  double calcDegrees() const {
    const MatrixXd information = jacobian_.transpose() * jacobian_;
    const double determined =
        linalg::solveCholesky(linalg::calcCholesky(hessian_).lower, information).trace();
    return std::max(1.0, static_cast<double>(jacobian_.rows()) - determined);
  }

 private:
  MatrixXd jacobian_, hessian_;
};

/// Judges features of one neighbourhood.
class Judge {
 public:
  virtual ~Judge() = default;
  /// The p-value where the features are moved, by change and noise together.
  virtual double calcPValue(const VectorXd& moved) const = 0;
};

/// By what the surrogate leaves, linearised where it explains the features without noise: its error there is
/// part of what is judged.
class SurrogateJudge final : public Judge {
 public:
  SurrogateJudge(const OnlineMap& map, const TrustModel& trust, const Neighbourhood& at)
      : trust_(trust),
        explanation_(explain(map, trust, at)),
        absorption_(explanation_.jacobian),
        centered_(at.features - trust.forward->center) {}

  double calcPValue(const VectorXd& moved) const override {
    const VectorXd scores = trust_.forward->projection * moved;
    const VectorXd innovation = explanation_.innovation + absorption_.remove(explanation_.whiten(scores));
    VectorXd residual;
    trust_.space.calcResidual(centered_ + moved, innovation, residual);
    Trust trust;
    compareWithSimulated(trust_, residual, trust);
    return trust.p_value;
  }

 private:
  static ScoreExplanation explain(const OnlineMap& map, const TrustModel& trust, const Neighbourhood& at) {
    OnlineMap::Workspace inferring(map);
    TrustWorkspace judging(trust);
    const Inference& inference = map.inferMean(at.features, at.known, inferring);
    judge(trust, at.features, at.known, inference, inferring.findExplanation(), judging);
    return *judging.explanation;
  }

  const TrustModel& trust_;
  const ScoreExplanation explanation_;
  const Absorption absorption_;
  const VectorXd centered_;
};

/// By what the simulator leaves; by the surrogate where that does not decide.
class RefinedJudge final : public Judge {
 public:
  RefinedJudge(const OnlineMap& map, const TrustModel& trust, const NoiseWhitener& noise,
               const Neighbourhood& at)
      : trust_(trust),
        noise_(noise),
        absorption_(noise.apply(at.sensitivities)),
        degrees_(absorption_.calcDegrees()),
        limit_(calcChiSquareLimit(degrees_)),
        surrogate_(map, trust, at) {}

  double calcPValue(const VectorXd& moved) const override {
    const VectorXd residual = absorption_.remove(noise_.apply(moved));
    const double chi_square = residual.squaredNorm();
    const SimulatorResidual found{residual, chi_square / degrees_, degrees_, chi_square < limit_, {}, {}};
    Trust by_surrogate;
    if (!found.explained) {
      by_surrogate.p_value = surrogate_.calcPValue(moved);
    }
    return judgeAnew(trust_, by_surrogate, found).p_value;
  }

 private:
  const TrustModel& trust_;
  const NoiseWhitener& noise_;
  const Absorption absorption_;
  const double degrees_, limit_;
  const SurrogateJudge surrogate_;
};

/// Where the power is looked at, and how.
struct PowerCases {
  std::vector<std::unique_ptr<Judge>> judges;  // one a neighbourhood
  Index draws = 0;                             // of each judge
  MatrixXd noise;                              // d x draws of each judge
  double level = 0.0;
};

/// Noise of the covariance factor factor', d x count.
MatrixXd drawNoise(const MatrixXd& factor, Index count, std::uint64_t seed) {
  const RandomStream random(seed, RandomPurpose::kTrustPower);
  MatrixXd white(factor.cols(), count);
  for (Index draw = 0; draw < count; ++draw) {
    for (Index i = 0; i < white.rows(); ++i) {
      white(i, draw) = random.calcNormal(static_cast<std::uint64_t>(draw), static_cast<std::uint64_t>(i));
    }
  }
  return factor * white;
}

/// The share of cases found where neighbourhood i is moved by size * directions[i].
double calcShareFound(const PowerCases& cases, const std::vector<VectorXd>& directions, double size) {
  int found = 0;
  for (std::size_t i = 0; i < cases.judges.size(); ++i) {
    for (Index draw = 0; draw < cases.draws; ++draw) {
      const VectorXd moved =
          size * directions[i] + cases.noise.col(static_cast<Index>(i) * cases.draws + draw);
      found += cases.judges[i]->calcPValue(moved) < cases.level ? 1 : 0;
    }
  }
  return static_cast<double>(found) / static_cast<double>(cases.noise.cols());
}

/// Bisects the logarithm of the size, to 5 %.
void findSmallest(const PowerCases& cases, const std::vector<VectorXd>& directions,
                  DetectableChange& change) {
  constexpr double kSpan = 1e-8, kStep = 1.05;  // of `largest`; the ratio at which the search ends
  change.found = calcShareFound(cases, directions, change.largest);
  change.smallest = std::numeric_limits<double>::quiet_NaN();
  if (change.found < kFound) {
    return;
  }
  double below = kSpan * change.largest, above = change.largest;
  while (above > kStep * below) {
    const double middle = std::sqrt(below * above);
    (calcShareFound(cases, directions, middle) < kFound ? below : above) = middle;
  }
  change.smallest = above;
}

/// The outputs' offsets: what they do to the features of each neighbourhood, and how far they may go.
std::vector<VectorXd> calcOffsetDirections(const PowerContext& context, Index output, double size,
                                           const std::vector<Neighbourhood>& around) {
  const ResponseLayout& layout = context.sets.test.layout;
  std::vector<VectorXd> directions;
  for (const Neighbourhood& at : around) {
    MatrixXd moved = at.response;
    moved.col(0).segment(layout.getRow(output, 0), layout.times.size()).array() += size;
    directions.emplace_back((context.extractor.extract(moved).col(0) - at.features) / size);
  }
  return directions;
}

double calcRange(const SimulatedSets& sets, Index output) {
  const auto rows =
      sets.test.responses.middleRows(sets.test.layout.getRow(output, 0), sets.test.layout.times.size());
  const MatrixXd values = rows(Eigen::all, findSuccessful(sets.test));
  return values.maxCoeff() - values.minCoeff();
}

bool areUsable(const std::vector<VectorXd>& directions) {
  return std::all_of(directions.begin(), directions.end(),
                     [](const VectorXd& one) { return one.allFinite(); }) &&
         std::any_of(directions.begin(), directions.end(),
                     [](const VectorXd& one) { return one.cwiseAbs().maxCoeff() > 0.0; });
}

PowerCases makeCases(const PowerContext& context, const NoiseWhitener& noise,
                     const std::vector<Neighbourhood>& around) {
  const TrustModel& trust = *context.online.trust;
  const OnlineMap map(context.online.map);
  PowerCases cases;
  cases.level = trust.level;
  for (const Neighbourhood& at : around) {
    if (trust.refinement.tried > 0) {
      cases.judges.push_back(std::make_unique<RefinedJudge>(map, trust, noise, at));
    } else {
      cases.judges.push_back(std::make_unique<SurrogateJudge>(map, trust, at));
    }
  }
  const MatrixXd factor = context.noise_covariance * noise.getMatrix().transpose();  // W C W' = 1
  const auto points = static_cast<Index>(around.size());
  cases.draws = kDraws / points;
  cases.noise = drawNoise(factor, cases.draws * points, context.experiment.seed);
  return cases;
}

}  // namespace

std::vector<DetectableChange> calcTrustPower(const PowerContext& context) {
  const std::vector<ParameterSpec> constants = listConstants(context.experiment.model);
  const std::vector<Neighbourhood> around = simulateNeighbourhoods(context, constants);
  std::vector<DetectableChange> changes;
  if (around.empty()) {
    return changes;
  }
  const NoiseWhitener noise(context.noise_covariance);
  const PowerCases cases = makeCases(context, noise, around);
  const auto add = [&](DetectableChange change, const std::vector<VectorXd>& directions) {
    if (areUsable(directions)) {
      findSmallest(cases, directions, change);
      changes.push_back(change);
    }
  };
  for (std::size_t i = 0; i < constants.size(); ++i) {
    std::vector<VectorXd> directions;
    for (const Neighbourhood& at : around) {
      directions.emplace_back(at.slopes.col(static_cast<Index>(i)));
    }
    add({"constant", constants[i].name.text, "", 0.0, kLargestChange, 0.0}, directions);
  }
  const ResponseLayout& layout = context.sets.test.layout;
  for (Index output = 0; output < layout.getOutputCount() && layout.times.size() > 0; ++output) {
    const double range = calcRange(context.sets, output);
    if (range > 0.0) {
      const auto name = static_cast<std::size_t>(output);
      add({"output", layout.output_names[name], layout.output_units[name], 0.0, range, 0.0},
          calcOffsetDirections(context, output, range, around));
    }
  }
  return changes;
}

std::string makeTrustPowerCsv(const std::vector<DetectableChange>& changes) {
  std::string text = "kind,name,unit,smallest_change,largest_change,largest_found\n";
  for (const DetectableChange& change : changes) {
    text += change.kind + "," + escapeCsv(change.name) + "," + escapeCsv(change.unit) + "," +
            (std::isfinite(change.smallest) ? toText(change.smallest) : "") + "," + toText(change.largest) +
            "," + toText(change.found) + "\n";
  }
  return text;
}

std::vector<std::string> listPowerWarnings(const std::vector<DetectableChange>& changes) {
  std::string names;
  for (const DetectableChange& change : changes) {
    if (change.found < kHardlyFound) {
      names += (names.empty() ? "" : ", ") + change.kind + " '" + change.name + "'";
    }
  }
  if (names.empty()) {
    return {};
  }
  return {
      "no power: measurements of a machine that differs by half in a constant, or by its range in the offset "
      "of an output, would mostly not be called a model_mismatch: " +
      names};
}

}  // namespace twinmap
