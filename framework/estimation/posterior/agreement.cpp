#include "framework/estimation/posterior/agreement.hpp"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "framework/base/random/random.hpp"
#include "framework/estimation/levels.hpp"
#include "framework/estimation/run_tasks.hpp"
#include "framework/simulation/simulator_team.hpp"
#include "kernels/linalg/decompositions.hpp"
#include "kernels/linalg/order.hpp"
#include "kernels/optimization/box_quadratic.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr int kReplicates = 1999;
constexpr double kTimes = 10.0;  // the p-value of the excess itself, which few contradictions need

/// Regular where it determines less than all.
MatrixXd regularize(MatrixXd information) {
  information.diagonal().array() +=
      kRegular * information.diagonal().maxCoeff() + std::numeric_limits<double>::min();
  return information;
}

/// By how much 2 g'd - d'Id grows above 0 within the box of steps.
double calcGain(const MatrixXd& information, const VectorXd& gradient, const VectorXd& lower,
                const VectorXd& upper) {
  const VectorXd step = optimization::minimizeQuadratic(regularize(information), -gradient, lower, upper);
  return 2.0 * gradient.dot(step) - step.dot(information * step);
}

/// A factor F with F F' = information, which may be singular.
MatrixXd factorizeInformation(const MatrixXd& information) {
  return linalg::calcCholesky(regularize(information)).lower;
}

/// What the parameters that have a normal prior gain of it alone, by its descent: its misfit.
double calcPriorGain(const MatrixXd& information, const VectorXd& descent) {
  std::vector<Index> known;
  for (Index j = 0; j < descent.size(); ++j) {
    if (information(j, j) > 0.0) {
      known.push_back(j);
    }
  }
  if (known.empty()) {
    return 0.0;
  }
  const VectorXd own = descent(known);
  return own.dot(linalg::solvePositiveDefinite(MatrixXd(information(known, known)), own));
}

/// The excess of one set of agreeing measurements with random errors, and with a prior that errs as it
/// states.
class ExcessSimulation {
 public:
  ExcessSimulation(const std::vector<PartInformation>& parts, const PriorMisfit& prior, const VectorXd& at,
                   std::uint64_t seed)
      : parts_(parts),
        prior_(prior.information),
        prior_descent_(prior.descent),
        prior_factor_(factorizeInformation(prior.information)),
        lower_(-1.0 - at.array()),
        upper_(1.0 - at.array()),
        total_(prior.information),
        random_(seed, RandomPurpose::kAgreement) {
    for (const PartInformation& part : parts) {
      factors_.push_back(factorizeInformation(part.information));
      total_(part.unknown, part.unknown) += part.information;
    }
  }

  /// Of measurements that agree.
  double simulateExcess(std::uint64_t replicate) const {
    std::vector<VectorXd> descents;
    for (std::size_t k = 0; k < parts_.size(); ++k) {
      descents.push_back(factors_[k] *
                         drawNormals(replicate, k, static_cast<Index>(parts_[k].unknown.size())));
    }
    return calcExcess(descents, prior_factor_ * drawNormals(replicate, parts_.size(), prior_.rows()));
  }

  /// Of those that were measured, by their linear models.
  double calcExcess() const {
    std::vector<VectorXd> descents;
    for (const PartInformation& part : parts_) {
      descents.push_back(part.descent);
    }
    return calcExcess(descents, prior_descent_);
  }

 private:
  VectorXd drawNormals(std::uint64_t replicate, std::size_t stream, Index count) const {
    VectorXd normals(count);
    random_.drawNormals(replicate, stream, normals.data(), static_cast<std::size_t>(count));
    return normals;
  }

  double calcExcess(const std::vector<VectorXd>& descents, const VectorXd& of_prior) const {
    VectorXd joint = of_prior;
    double excess = calcPriorGain(prior_, of_prior);
    for (std::size_t k = 0; k < parts_.size(); ++k) {
      const std::vector<Index>& unknown = parts_[k].unknown;
      joint(unknown) += descents[k];
      const MatrixXd prior = prior_(unknown, unknown);
      const VectorXd own_prior = of_prior(unknown);
      excess +=
          calcGain(parts_[k].information + prior, descents[k] + own_prior, lower_(unknown), upper_(unknown)) -
          calcPriorGain(prior, own_prior);
    }
    return excess - calcGain(total_, joint, lower_, upper_);
  }

  const std::vector<PartInformation>& parts_;
  const MatrixXd prior_;
  const VectorXd prior_descent_;
  const MatrixXd prior_factor_;
  const VectorXd lower_, upper_;
  std::vector<MatrixXd> factors_;
  MatrixXd total_;
  const RandomStream random_;
};

/// How often measurements that agree have such an excess at most: where each determines all that it has in
/// common with others, and the prior, which one at most of them explains, errs as it states.
double calcLargestProbability(double excess, const std::vector<PartInformation>& parts,
                              const MatrixXd& prior) {
  auto degrees =
      static_cast<double>((prior.diagonal().array() > 0.0).count()) - static_cast<double>(prior.rows());
  for (const PartInformation& part : parts) {
    degrees += static_cast<double>(part.unknown.size());
  }
  if (!(degrees > 0.0) || !(excess > 0.0)) {
    return 1.0;
  }
  return boost::math::cdf(boost::math::complement(boost::math::chi_squared(degrees), excess));
}

}  // namespace

std::vector<PartInformation> linearizeParts(const PosteriorProblem& problem, const VectorXd& best) {
  std::vector<PartInformation> parts(problem.trials.size());
  runTasks(mayRunSideBySide(problem) ? countThreads() : 1, parts.size(), [&](std::size_t k) {
    const MeasuredTrial& trial = problem.trials[k];
    const std::vector<ParameterSpec>& unknown = trial.model->getUnknown();
    const LogCoordinates coordinates(unknown);
    const Prior uniform({}, {});
    TrialMisfit own(trial);
    MisfitSurface surface(
        {{&own.misfit, trial.model, listIndices(unknown.size()), makeLosses(trial.noise, *trial.model)}},
        coordinates, uniform);
    const LocalSurface local = surface.linearize(coordinates.fromParameters(best(trial.unknown))).front();
    if (!local.simulated) {
      throw std::runtime_error("the joint estimate cannot be simulated");
    }
    parts[k] = {trial.unknown, local.information, local.descent};
  });
  return parts;
}

bool Agreement::isAtFloor() const {
  return p_value < 1.5 / (kReplicates + 1.0);
}

Agreement testAgreement(double joint_misfit, const std::vector<double>& separate_misfits,
                        const std::vector<PartInformation>& parts, const PosteriorProblem& problem,
                        const VectorXd& best, std::uint64_t seed) {
  Agreement agreement;
  agreement.excess = joint_misfit - std::accumulate(separate_misfits.begin(), separate_misfits.end(), 0.0);
  const LogCoordinates coordinates(problem.unknown);
  const VectorXd at = coordinates.fromParameters(best);
  const Prior known(problem.unknown, problem.priors);
  const PriorMisfit prior = MisfitSurface({}, coordinates, known).linearizePrior(at);
  const ExcessSimulation simulation(parts, prior, at, seed);
  const double linear = simulation.calcExcess();
  int as_large = 0;
  for (int i = 0; i < kReplicates; ++i) {
    as_large += simulation.simulateExcess(static_cast<std::uint64_t>(i)) >= linear ? 1 : 0;
  }
  const double of_scores = (1.0 + as_large) / (kReplicates + 1.0);
  const double of_excess = kTimes * calcLargestProbability(agreement.excess, parts, prior.information);
  agreement.p_value = std::max(std::min(of_scores, of_excess), 1.0 / (kReplicates + 1.0));
  return agreement;
}

}  // namespace twinmap
