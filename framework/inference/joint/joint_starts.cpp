#include "framework/inference/joint/joint_starts.hpp"

#include "framework/estimation/box_points.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// The best of a recording alone, without what it had in addition (the sizes of a clock's faults).
VectorXd takeOwn(const RecordingInference& alone, const std::vector<Index>& unknown) {
  return alone.posterior.best.head(static_cast<Index>(unknown.size()));
}

/// The minimum of the sum of the recordings' quadratic misfits about their own minima. Each is over what it
/// alone leaves unknown; the sum is nearly that of all together. The prior counts in each, which moves it by
/// little.
VectorXd combineMinima(const PosteriorProblem& problem, const std::vector<RecordingInference>& alone,
                       const VectorXd& base) {
  const LogCoordinates coordinates(problem.unknown);
  const Index all = base.size();
  MatrixXd information = kHalfWidthInformation * MatrixXd::Identity(all, all);
  VectorXd descent = VectorXd::Zero(all);
  for (std::size_t k = 0; k < alone.size(); ++k) {
    const std::vector<Index>& own = problem.trials[k].unknown;
    VectorXd point = base;
    point(own) = takeOwn(alone[k], own);
    const VectorXd at = coordinates.fromParameters(point);
    const auto count = static_cast<Index>(own.size());
    const MatrixXd of_own = alone[k].posterior.information.topLeftCorner(count, count);
    information(own, own) += of_own;
    descent(own) += of_own * at(own);
  }
  const VectorXd minimum = linalg::solvePositiveDefinite(information, descent);
  return coordinates.toParameters(clampToBox(minimum));
}

}  // namespace

MatrixXd listJointStarts(const PosteriorProblem& problem, const std::vector<RecordingInference>& alone,
                         Index shared) {
  VectorXd base = VectorXd::Zero(static_cast<Index>(problem.unknown.size()));
  for (std::size_t k = 0; k < alone.size(); ++k) {
    base(problem.trials[k].unknown) = takeOwn(alone[k], problem.trials[k].unknown);
  }
  std::vector<VectorXd> starts;
  VectorXd sum = VectorXd::Zero(shared), weight = VectorXd::Zero(shared);
  for (const RecordingInference& one : alone) {
    const SimulatorPosterior& posterior = one.posterior;
    starts.push_back(base);
    starts.back().head(shared) = posterior.best.head(shared);
    for (std::size_t m = 1; m < posterior.modes.size(); ++m) {
      starts.push_back(base);
      starts.back().head(shared) = posterior.modes[m].mean.head(shared);
    }
    if (posterior.isReliable()) {
      const VectorXd own = posterior.stddev.head(shared).cwiseAbs2().cwiseInverse();
      sum += own.cwiseProduct(posterior.mean.head(shared));
      weight += own;
    }
  }
  if (problem.drawn > kManyUnknown) {
    starts.insert(starts.begin(), combineMinima(problem, alone, base));
  } else if (weight.minCoeff() > 0.0) {
    starts.push_back(base);
    starts.back().head(shared) = sum.cwiseQuotient(weight);
  }
  MatrixXd given(base.size(), static_cast<Index>(starts.size()));
  for (std::size_t i = 0; i < starts.size(); ++i) {
    given.col(static_cast<Index>(i)) = starts[i];
  }
  return given;
}

}  // namespace twinmap
