#include "kernels/gp/polish.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernels/linalg/decompositions.hpp"
#include "kernels/optimization/box_quadratic.hpp"

namespace twinmap::gp {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr double kPromised = 1e-3;  // nats
constexpr double kMostStep = 1.0;   // in log-hyperparameters

struct Place {
  VectorXd point, gradient;  // prior included
  double nlml = 0.0, value = std::numeric_limits<double>::infinity();
};

Place look(const Objective& objective, const VectorXd& point, const SearchBox& box, SearchResult& result) {
  Place place{point, VectorXd::Zero(point.size())};
  const LikelihoodEvaluation evaluation = objective(point, place.gradient);
  ++result.evaluations;
  result.largest_jitter = std::max(result.largest_jitter, evaluation.jitter);
  if (evaluation.ok) {
    const VectorXd pull = box.prior_precision.cwiseProduct(point - box.prior_mean);
    place.gradient += pull;
    place.nlml = evaluation.nlml;
    place.value = evaluation.nlml + 0.5 * pull.dot(point - box.prior_mean);
  }
  return place;
}

/// A matrix with the same eigenvectors whose eigenvalues are their magnitudes, at least some: downhill from a
/// saddle, and no endless steps where a hyperparameter hardly matters.
MatrixXd makePositive(const MatrixXd& matrix) {
  constexpr double kLeast = 0.1;  // nats: a factor of e then costs a twentieth of a nat
  const linalg::SymmetricEigen eigen = linalg::calcSymmetricEigen(matrix);
  return eigen.vectors * eigen.values.cwiseAbs().cwiseMax(kLeast).asDiagonal() * eigen.vectors.transpose();
}

/// BFGS with Powell's damping, which keeps the curvature positive.
void learn(const Place& from, const Place& to, MatrixXd& curvature) {
  constexpr double kLeast = 0.2;  // of the curvature along the step so far (Powell 1978)
  const VectorXd step = to.point - from.point, known = curvature * step;
  const double expected = step.dot(known);
  if (!(expected > 0.0)) {
    return;
  }
  VectorXd seen = to.gradient - from.gradient;
  const double along = step.dot(seen);
  if (along < kLeast * expected) {
    const double share = (1.0 - kLeast) * expected / (expected - along);
    seen = share * seen + (1.0 - share) * known;
  }
  curvature += seen * seen.transpose() / step.dot(seen) - known * known.transpose() / expected;
}

void keep(const Place& place, SearchResult& result) {
  result.end = place.point;
  result.nlml = place.nlml;
  result.objective = place.value;
}

/// From `at`; true once a step promises nothing.
bool descend(const Objective& objective, const SearchBox& box, const SearchLimits& limits, Place at,
             MatrixXd curvature, SearchResult& result) {
  constexpr double kShorter = 0.3, kShortest = 1e-4;
  double radius = kMostStep;
  while (radius > kShortest && result.evaluations < limits.max_evaluations && !isStopRequested(limits.stop)) {
    VectorXd step =
        optimization::minimizeQuadratic(curvature, at.gradient, box.lower - at.point, box.upper - at.point);
    const double promised = -at.gradient.dot(step) - 0.5 * step.dot(curvature * step);
    if (promised < std::max(kPromised, limits.tolerance)) {
      return true;
    }
    const double longest = step.cwiseAbs().maxCoeff();
    step *= std::min(1.0, radius / longest);
    const Place tried =
        look(objective, (at.point + step).cwiseMax(box.lower).cwiseMin(box.upper), box, result);
    if (std::isfinite(tried.value)) {
      learn(at, tried, curvature);
    }
    if (tried.value < at.value) {
      radius = std::min(kMostStep, 2.0 * radius);
      at = tried;
      keep(at, result);
    } else {
      radius = kShorter * std::min(longest, radius);
    }
  }
  return false;
}

}  // namespace

MatrixXd calcCurvature(const Objective& objective, const VectorXd& point, const SearchBox& box) {
  constexpr double kStep =
      1e-3;  // rounding of the gradient stays below 1e-3 of it, and so does its third order
  const Index k = point.size();
  VectorXd centre(k), moved(k);
  MatrixXd curvature = MatrixXd::Zero(k, k);
  bool ok = objective(point, centre).ok;
  for (Index i = 0; i < k && ok; ++i) {
    VectorXd at = point;
    const double step = at(i) + kStep <= box.upper(i) ? kStep : -kStep;
    at(i) += step;
    ok = objective(at, moved).ok;
    curvature.col(i) = (moved - centre) / step;
  }
  if (!ok || !curvature.allFinite()) {
    return MatrixXd::Zero(k, k);
  }
  return 0.5 * (curvature + curvature.transpose());
}

MatrixXd calcCurvature(const TrainingSet& set, const VectorXd& target, const Hyperparameters& hyperparameters,
                       const SearchBox& box, LikelihoodWorkspace& workspace) {
  const Objective objective = [&](const VectorXd& point, VectorXd& gradient) {
    return evaluateLikelihoodGradient(set, target, fromLog(set.getStructure(), point), workspace, gradient);
  };
  return calcCurvature(objective, toLog(set.getStructure(), hyperparameters), box);
}

SearchResult polish(const Objective& objective, const VectorXd& start, const MatrixXd& curvature,
                    const SearchBox& box, const SearchLimits& limits) {
  SearchResult result;
  const VectorXd point = start.cwiseMax(box.lower).cwiseMin(box.upper);
  result.stop_reason = "asked to stop";
  keep({point, {}, std::numeric_limits<double>::infinity()}, result);
  if (isStopRequested(limits.stop)) {
    return result;
  }
  const Place first = look(objective, point, box, result);
  keep(first, result);
  const MatrixXd whole = curvature + MatrixXd(box.prior_precision.asDiagonal());
  if (!std::isfinite(first.value)) {
    result.stop_reason = "its start cannot be evaluated";
    return result;
  }
  result.converged = descend(objective, box, limits, first, makePositive(whole), result);
  if (!isStopRequested(limits.stop)) {
    result.stop_reason =
        result.converged ? "a step promises less than the tolerance" : "its steps found no further progress";
  }
  return result;
}

}  // namespace twinmap::gp
