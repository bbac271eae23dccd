#include "framework/estimation/posterior/agreement.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "framework/base/random/random.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr int kReplicates = 1999;

/// By how much 2 g'd - d'Id grows above 0 within the box of steps: free coordinates by Newton's step, those
/// that would leave the box held at its side, until none does.
double calcGain(const MatrixXd& information, const VectorXd& gradient, const VectorXd& lower,
                const VectorXd& upper) {
  const Index u = gradient.size();
  VectorXd step = VectorXd::Zero(u);
  std::vector<Index> free(static_cast<std::size_t>(u)), held;
  std::iota(free.begin(), free.end(), Index{0});
  for (Index round = 0; round <= u && !free.empty(); ++round) {
    MatrixXd own = information(free, free);
    own.diagonal().array() += 1e-10 * own.diagonal().maxCoeff() + std::numeric_limits<double>::min();
    VectorXd own_gradient = gradient(free);
    if (!held.empty()) {
      own_gradient -= information(free, held) * step(held);
    }
    step(free) = linalg::solvePositiveDefinite(own, own_gradient);
    std::vector<Index> inside;
    for (const Index j : free) {
      if (step[j] < lower[j] || step[j] > upper[j]) {
        step[j] = std::clamp(step[j], lower[j], upper[j]);
        held.push_back(j);
      } else {
        inside.push_back(j);
      }
    }
    if (inside.size() == free.size()) {
      break;
    }
    free = std::move(inside);
  }
  return 2.0 * gradient.dot(step) - step.dot(information * step);
}

/// A factor F with F F' = information, which may be singular.
MatrixXd factorizeInformation(const MatrixXd& information) {
  MatrixXd regular = information;
  regular.diagonal().array() +=
      1e-10 * information.diagonal().maxCoeff() + std::numeric_limits<double>::min();
  return linalg::calcCholesky(regular).lower;
}

/// The information of the prior near a point, in LogCoordinates.
MatrixXd linearizePrior(const PosteriorProblem& problem, const LogCoordinates& coordinates,
                        const VectorXd& at) {
  const Prior prior(problem.unknown, problem.priors);
  if (prior.isUniform()) {
    return MatrixXd::Zero(at.size(), at.size());
  }
  const VectorXd slopes = coordinates.calcSlopes(at).cwiseProduct(coordinates.getHalfWidths());
  return slopes.asDiagonal() * prior.calcMisfit(coordinates.toParameters(at)).information *
         slopes.asDiagonal();
}

/// The excess of one set of agreeing measurements with random errors, and with a prior that errs as it
/// states.
class ExcessSimulation {
 public:
  ExcessSimulation(const std::vector<PartInformation>& parts, const MatrixXd& prior, const VectorXd& at,
                   std::uint64_t seed)
      : parts_(parts),
        prior_(prior),
        prior_factor_(factorizeInformation(prior)),
        lower_(-1.0 - at.array()),
        upper_(1.0 - at.array()),
        total_(prior),
        random_(seed, RandomPurpose::kAgreement) {
    for (const PartInformation& part : parts) {
      factors_.push_back(factorizeInformation(part.information));
      total_(part.unknown, part.unknown) += part.information;
    }
  }

  double calcExcess(std::uint64_t replicate) const {
    const VectorXd errors = drawNormals(replicate, parts_.size(), prior_.rows());
    const VectorXd of_prior = prior_factor_ * errors;
    VectorXd joint = of_prior;
    double excess = calcPriorMisfit(errors);
    for (std::size_t k = 0; k < parts_.size(); ++k) {
      const std::vector<Index>& unknown = parts_[k].unknown;
      const VectorXd gradient = factors_[k] * drawNormals(replicate, k, static_cast<Index>(unknown.size()));
      joint(unknown) += gradient;
      const VectorXd own = gradient + of_prior(unknown);
      excess +=
          calcGain(parts_[k].information + prior_(unknown, unknown), own, lower_(unknown), upper_(unknown)) -
          calcPriorMisfit(errors, unknown);
    }
    return excess - calcGain(total_, joint, lower_, upper_);
  }

 private:
  VectorXd drawNormals(std::uint64_t replicate, std::size_t stream, Index count) const {
    VectorXd normals(count);
    random_.drawNormals(replicate, stream, normals.data(), static_cast<std::size_t>(count));
    return normals;
  }

  double calcPriorMisfit(const VectorXd& errors) const {
    return (prior_.diagonal().array() > 0.0).select(errors.array().square(), 0.0).sum();
  }
  double calcPriorMisfit(const VectorXd& errors, const std::vector<Index>& unknown) const {
    return (prior_.diagonal()(unknown).array() > 0.0).select(errors(unknown).array().square(), 0.0).sum();
  }

  const std::vector<PartInformation>& parts_;
  const MatrixXd prior_, prior_factor_;
  const VectorXd lower_, upper_;
  std::vector<MatrixXd> factors_;
  MatrixXd total_;
  const RandomStream random_;
};

}  // namespace

std::vector<PartInformation> linearizeParts(const PosteriorProblem& problem, const VectorXd& best) {
  std::vector<PartInformation> parts;
  for (const MeasuredTrial& trial : problem.trials) {
    const std::vector<ParameterSpec>& unknown = trial.model->getUnknown();
    const LogCoordinates coordinates(unknown);
    const Prior uniform({}, {});
    const SearchBox box(unknown, {0, static_cast<Index>(unknown.size())}, trial.held);
    Misfit misfit(*trial.simulator, *trial.model, box, trial.features);
    std::vector<Index> own(unknown.size());
    std::iota(own.begin(), own.end(), Index{0});
    MisfitSurface surface({{&misfit, trial.model, own, makeLosses(trial.noise, *trial.model)}}, coordinates,
                          uniform);
    const LocalSurface local = surface.linearize(coordinates.fromParameters(best(trial.unknown))).front();
    if (!local.simulated) {
      throw std::runtime_error("the joint estimate cannot be simulated");
    }
    parts.push_back({trial.unknown, local.information});
  }
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
  const ExcessSimulation simulation(parts, linearizePrior(problem, coordinates, at), at, seed);
  int as_large = 0;
  for (int i = 0; i < kReplicates; ++i) {
    as_large += simulation.calcExcess(static_cast<std::uint64_t>(i)) >= agreement.excess ? 1 : 0;
  }
  agreement.p_value = (1.0 + as_large) / (kReplicates + 1.0);
  return agreement;
}

}  // namespace twinmap
