#include "framework/experiment/trust_power.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>

#include "framework/design/random.hpp"
#include "framework/features/noise_whitener.hpp"
#include "framework/multibody/multibody_simulator.hpp"
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

constexpr Index kPoints = 10;           // test samples: power differs over the box
constexpr double kConstantSpan = 0.2;   // relative; the interval of a constant that is made a parameter
constexpr double kLargestChange = 0.5;  // of a constant
constexpr double kFound = 0.95, kHardlyFound = 0.5;

/// The constants whose values are numbers other than zero.
std::vector<ParameterSpec> listConstants(const ModelSpec& model) {
  std::vector<ParameterSpec> constants;
  for (const ConstantSpec& constant : model.constants) {
    char* end = nullptr;
    const double value = std::strtod(constant.value.text.c_str(), &end);
    if (*end == '\0' && std::abs(value) > 0.0) {
      ParameterSpec parameter;
      parameter.name = constant.name;
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

/// The first test samples as points of that model's box.
MatrixXd makePoints(const ExperimentSpec& experiment, const SimulatedSets& sets,
                    const std::vector<ParameterSpec>& constants) {
  std::vector<int> samples = findSuccessful(sets.test);
  samples.resize(std::min<std::size_t>(samples.size(), kPoints));
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
  const MultibodySimulator simulator(model, layout.times, layout.modes);
  const MatrixXd points = makePoints(context.experiment, context.sets, constants);
  const auto count = static_cast<Index>(constants.size());
  std::vector<Neighbourhood> found;
  Index column = 0;
  for (const LocalModel& local :
       calcLocalModels(simulator, context.extractor, collectUnknown(model), points, context.threads)) {
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

/// Judges features of one neighbourhood with noise, `sample`-th draw, that are moved by `change`.
class Judge {
 public:
  virtual ~Judge() = default;
  virtual int countDraws() const = 0;
  virtual Trust judgeMoved(const VectorXd& change, std::uint64_t sample) = 0;
};

/// What the simulator leaves where the parameters take up what they can of noise and change.
class RefinedJudge final : public Judge {
 public:
  RefinedJudge(const TrustModel& trust, const NoiseWhitener& noise, const Neighbourhood& at,
               const RandomStream& random)
      : trust_(trust), noise_(noise), random_(random), jacobian_(noise.apply(at.sensitivities)) {
    const MatrixXd information = jacobian_.transpose() * jacobian_;
    hessian_ = information;
    hessian_.diagonal().array() += kHalfWidthInformation;
    const MatrixXd factor = linalg::calcCholesky(hessian_).lower;
    const double determined = linalg::solveCholesky(factor, information).trace();
    degrees_ = std::max(1.0, static_cast<double>(jacobian_.rows()) - determined);
    limit_ = calcChiSquareLimit(degrees_);
  }

  int countDraws() const override { return 20; }

  Trust judgeMoved(const VectorXd& change, std::uint64_t sample) override {
    VectorXd residual = noise_.apply(change);
    for (Index i = 0; i < residual.size(); ++i) {
      residual[i] += random_.calcNormal(sample, static_cast<std::uint64_t>(i));
    }
    const VectorXd step = linalg::solvePositiveDefinite(hessian_, jacobian_.transpose() * residual);
    residual -= jacobian_ * step;
    const double chi_square = residual.squaredNorm();
    return judgeAnew(trust_, {}, {residual, chi_square / degrees_, degrees_, chi_square < limit_, {}, {}});
  }

 private:
  const TrustModel& trust_;
  const NoiseWhitener& noise_;
  const RandomStream& random_;
  MatrixXd jacobian_, hessian_;
  double degrees_ = 1.0, limit_ = 0.0;
};

/// The map and its trust model.
class OnlineJudge final : public Judge {
 public:
  OnlineJudge(const OnlineMap& map, const TrustModel& trust, const MatrixXd& noise_factor,
              const Neighbourhood& at, const RandomStream& random)
      : map_(map),
        trust_(trust),
        noise_factor_(noise_factor),
        at_(at),
        random_(random),
        inferring_(map),
        judging_(trust) {}

  int countDraws() const override { return 5; }

  Trust judgeMoved(const VectorXd& change, std::uint64_t sample) override {
    VectorXd noise(noise_factor_.cols());
    for (Index i = 0; i < noise.size(); ++i) {
      noise[i] = random_.calcNormal(sample, static_cast<std::uint64_t>(i));
    }
    const VectorXd features = at_.features + change + noise_factor_ * noise;
    return judge(trust_, features, at_.known, map_.inferMean(features, at_.known, inferring_), judging_);
  }

 private:
  const OnlineMap& map_;
  const TrustModel& trust_;
  const MatrixXd& noise_factor_;
  const Neighbourhood& at_;
  const RandomStream& random_;
  OnlineMap::Workspace inferring_;
  TrustWorkspace judging_;
};

/// All neighbourhoods with their judges.
using Judges = std::vector<std::unique_ptr<Judge>>;

/// The share of cases found where neighbourhood i is moved by size * directions[i].
double calcShareFound(const Judges& judges, const std::vector<VectorXd>& directions, double size,
                      double level) {
  int found = 0, count = 0;
  for (std::size_t i = 0; i < judges.size(); ++i) {
    for (int draw = 0; draw < judges[i]->countDraws(); ++draw, ++count) {
      const VectorXd change = size * directions[i];
      found += judges[i]->judgeMoved(change, static_cast<std::uint64_t>(count)).p_value < level ? 1 : 0;
    }
  }
  return static_cast<double>(found) / count;
}

/// Bisects the logarithm of the size, to 5 %.
void findSmallest(const Judges& judges, const std::vector<VectorXd>& directions, double level,
                  DetectableChange& change) {
  constexpr double kSpan = 1e-8, kStep = 1.05;  // of `largest`; the ratio at which the search ends
  change.found = calcShareFound(judges, directions, change.largest, level);
  change.smallest = std::numeric_limits<double>::quiet_NaN();
  if (change.found < kFound) {
    return;
  }
  double below = kSpan * change.largest, above = change.largest;
  while (above > kStep * below) {
    const double middle = std::sqrt(below * above);
    (calcShareFound(judges, directions, middle, level) < kFound ? below : above) = middle;
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

Judges makeJudges(const PowerContext& context, const NoiseWhitener& noise, const MatrixXd& noise_factor,
                  const OnlineMap& map, const RandomStream& random,
                  const std::vector<Neighbourhood>& around) {
  const TrustModel& trust = *context.online.trust;
  Judges judges;
  for (const Neighbourhood& at : around) {
    if (trust.refinement.tried > 0) {
      judges.push_back(std::make_unique<RefinedJudge>(trust, noise, at, random));
    } else {
      judges.push_back(std::make_unique<OnlineJudge>(map, trust, noise_factor, at, random));
    }
  }
  return judges;
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
  const MatrixXd noise_factor = context.noise_covariance * noise.getMatrix().transpose();  // W C W' = 1
  const OnlineMap map(context.online.map);
  const RandomStream random(context.experiment.seed, RandomPurpose::kTrustPower);
  const Judges judges = makeJudges(context, noise, noise_factor, map, random, around);
  const auto add = [&](DetectableChange change, const std::vector<VectorXd>& directions) {
    if (areUsable(directions)) {
      findSmallest(judges, directions, context.online.trust->level, change);
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
