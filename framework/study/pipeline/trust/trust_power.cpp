#include "framework/study/pipeline/trust/trust_power.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "framework/base/log/notice.hpp"
#include "framework/base/random/random.hpp"
#include "framework/base/text/csv.hpp"
#include "framework/base/text/number_text.hpp"
#include "framework/data/noise/noise_whitener.hpp"
#include "framework/estimation/refined/acceptance.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Judges features of one stencil.
class PowerJudge {
 public:
  virtual ~PowerJudge() = default;
  /// The p-value where the features are moved, by change and noise together (d).
  virtual double calcPValue(const Eigen::VectorXd& moved) const = 0;
};

/// What parameters take up of whitened residuals: J (J'J + prior)^-1 J', J per half-width.
class Absorption {
 public:
  Absorption(MatrixXd jacobian, const BoxPrior& prior)
      : jacobian_(std::move(jacobian)),
        hessian_(jacobian_.transpose() * jacobian_ + prior.calcInformation()) {}

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

/// By what the surrogate leaves, linearised where it explains the features without noise: its error there is
/// part of what is judged.
class SurrogateJudge final : public PowerJudge {
 public:
  SurrogateJudge(const Estimator& map, const TrustModel& trust, const Stencil& at)
      : trust_(trust),
        explanation_(explain(map, trust, at)),
        absorption_(explanation_.jacobian, trust.prior),
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
  static ScoreExplanation explain(const Estimator& map, const TrustModel& trust, const Stencil& at) {
    const std::unique_ptr<Estimator::Workspace> inferring = map.makeWorkspace();
    TrustWorkspace judging(trust);
    const Estimate& estimate = map.inferMean(at.features, at.known, *inferring);
    judge(trust, at.features, at.known, estimate, inferring->findExplanation(), judging);
    return *judging.explanation;
  }

  const TrustModel& trust_;
  const ScoreExplanation explanation_;
  const Absorption absorption_;
  const VectorXd centered_;
};

/// By what the simulator leaves; by the surrogate where that does not decide.
class RefinedJudge final : public PowerJudge {
 public:
  RefinedJudge(const Estimator& map, const TrustModel& trust, const NoiseWhitener& noise, const Stencil& at)
      : trust_(trust),
        noise_(noise),
        absorption_(noise.apply(at.sensitivities), trust.prior),
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

/// By what the simulator leaves where the run's test samples were refined, else by what the surrogate leaves;
/// parameters take up what they can, linearly. All but the stencil must outlive it.
std::unique_ptr<PowerJudge> makePowerJudge(const Estimator& map, const TrustModel& trust,
                                           const NoiseWhitener& noise, const Stencil& at) {
  if (trust.refinement.tried > 0) {
    return std::make_unique<RefinedJudge>(map, trust, noise, at);
  }
  return std::make_unique<SurrogateJudge>(map, trust, at);
}

constexpr Index kDraws = 200;           // of all points: they tell a share of 95 % to 1.5 %
constexpr double kLargestChange = 0.5;  // of a constant
constexpr double kFound = 0.95, kHardlyFound = 0.5;

/// Where the power is looked at, and how.
struct PowerCases {
  std::vector<std::unique_ptr<PowerJudge>> judges;  // one a stencil
  Index draws = 0;                                  // of each judge
  MatrixXd noise;                                   // d x draws of each judge
  double level = 0.0;
};

/// Noise of a covariance C = F F', d x count; F = C W', since W C W' = 1.
MatrixXd drawNoise(const NoiseCovariance& covariance, const NoiseWhitener& noise, Index count,
                   std::uint64_t seed) {
  const RandomStream random(seed, RandomPurpose::kTrustPower);
  MatrixXd white(noise.countDirections(), count);
  for (Index draw = 0; draw < count; ++draw) {
    random.drawNormals(static_cast<std::uint64_t>(draw), 0, white.col(draw).data(),
                       static_cast<std::size_t>(white.rows()));
  }
  return covariance * noise.applyTransposed(white);
}

/// The share of cases found where stencil i is moved by size * directions[i]; once it is below `least`, what
/// it is at most.
double calcShareFound(const PowerCases& cases, const std::vector<VectorXd>& directions, double size,
                      double least = 0.0) {
  const Index count = cases.noise.cols();
  Index at_most = count;
  const auto share = [&] { return static_cast<double>(at_most) / static_cast<double>(count); };
  for (Index i = 0; i < count && share() >= least; ++i) {
    const auto stencil = static_cast<std::size_t>(i / cases.draws);
    const VectorXd moved = size * directions[stencil] + cases.noise.col(i);
    at_most -= cases.judges[stencil]->calcPValue(moved) < cases.level ? 0 : 1;
  }
  return share();
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
    (calcShareFound(cases, directions, middle, kFound) < kFound ? below : above) = middle;
  }
  change.smallest = above;
}

/// The outputs' offsets: what they do to the features of each stencil, and how far they may go.
std::vector<VectorXd> calcOffsetDirections(const Study& study, Index output, double size,
                                           const std::vector<Stencil>& around) {
  const ResponseLayout& layout = study.simulator.getLayout();
  std::vector<VectorXd> directions;
  for (const Stencil& at : around) {
    MatrixXd moved = at.response;
    moved.col(0).segment(layout.getRow(output, 0), layout.times.size()).array() += size;
    directions.emplace_back((study.extractor.extract(moved).col(0) - at.features) / size);
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

PowerCases makeCases(const Study& study, const OnlineModel& online, const NoiseWhitener& noise,
                     const NoiseCovariance& noise_covariance, const std::vector<Stencil>& around) {
  const TrustModel& trust = *online.trust;
  const Estimator& map = *online.map;
  PowerCases cases;
  cases.level = trust.level;
  for (const Stencil& at : around) {
    cases.judges.push_back(makePowerJudge(map, trust, noise, at));
  }
  const auto points = static_cast<Index>(around.size());
  cases.draws = kDraws / points;
  cases.noise = drawNoise(noise_covariance, noise, cases.draws * points, study.experiment.seed);
  return cases;
}

}  // namespace

std::vector<DetectableChange> calcTrustPower(const Study& study, const PreparedData& data,
                                             const OnlineModel& online) {
  const std::vector<ParameterSpec> constants = listConstants(study.experiment.model);
  const std::vector<Stencil> around = simulateStencils(study, data.sets, constants);
  std::vector<DetectableChange> changes;
  if (around.empty()) {
    return changes;
  }
  const NoiseCovariance& covariance = data.labelled.train.noise_covariance;
  const NoiseWhitener noise(covariance);
  const PowerCases cases = makeCases(study, online, noise, covariance, around);
  const auto add = [&](DetectableChange change, const std::vector<VectorXd>& directions) {
    if (areUsable(directions)) {
      findSmallest(cases, directions, change);
      changes.push_back(change);
    }
  };
  for (std::size_t i = 0; i < constants.size(); ++i) {
    std::vector<VectorXd> directions;
    for (const Stencil& at : around) {
      directions.emplace_back(at.slopes.col(static_cast<Index>(i)));
    }
    add({"constant", constants[i].name.text, "", 0.0, kLargestChange, 0.0}, directions);
  }
  const ResponseLayout& layout = data.sets.test.layout;
  for (Index output = 0; output < layout.getOutputCount() && layout.times.size() > 0; ++output) {
    const double range = calcRange(data.sets, output);
    if (range > 0.0) {
      const auto name = static_cast<std::size_t>(output);
      add({"output", layout.output_names[name], layout.output_units[name], 0.0, range, 0.0},
          calcOffsetDirections(study, output, range, around));
    }
  }
  return changes;
}

std::string makeTrustPowerCsv(const std::vector<DetectableChange>& changes) {
  std::vector<CsvRow> rows{{"kind", "name", "unit", "smallest_change", "largest_change", "largest_found"}};
  for (const DetectableChange& change : changes) {
    rows.push_back({change.kind, change.name, change.unit,
                    std::isfinite(change.smallest) ? toText(change.smallest) : "", toText(change.largest),
                    toText(change.found)});
  }
  return makeCsv(rows);
}

namespace {

/// "a 50 % error in ds", "an offset of y by its whole range".
std::string describe(const DetectableChange& change) {
  return change.kind == "constant" ? "a 50 % error in " + change.name
                                   : "an offset of " + change.name + " by its whole range";
}

}  // namespace

std::vector<std::string> listPowerWarnings(const std::vector<DetectableChange>& changes) {
  std::string names;
  for (const DetectableChange& change : changes) {
    if (change.found < kHardlyFound) {
      names += (names.empty() ? "" : ", ") + describe(change);
    }
  }
  if (names.empty()) {
    return {};
  }
  return {describeNotice(Notice::kBlindSpots, names)};
}

}  // namespace twinmap
