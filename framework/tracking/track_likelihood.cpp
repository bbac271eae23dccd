#include "framework/tracking/track_likelihood.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernels/linalg/decompositions.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

NormalBelief toSpace(const VectorXd& mean, const MatrixXd& covariance, const TrackSpace& space) {
  NormalBelief belief{VectorXd(space.count()), {}};
  VectorXd slopes(space.count());
  for (Index j = 0; j < space.count(); ++j) {
    belief.mean[j] = space.toCoordinate(j, mean[j]);
    slopes[j] = space.calcSlope(j, mean[j]);
  }
  belief.covariance = slopes.asDiagonal() * covariance * slopes.asDiagonal();
  return belief;
}

/// log density of one belief's mean under both, but for a constant.
double calcLogOverlap(const NormalBelief& one, const NormalBelief& other) {
  const linalg::Cholesky factor = linalg::calcCholesky(one.covariance + other.covariance);
  const VectorXd off = linalg::solveLower(factor.lower, one.mean - other.mean);
  return -0.5 * off.squaredNorm() - factor.lower.diagonal().array().log().sum();
}

NormalBelief chooseMode(const Estimate& estimate, const TrackSpace& space, const NormalBelief& believed) {
  const Mixture& mixture = estimate.mixture;
  NormalBelief chosen;
  double best = -std::numeric_limits<double>::infinity();
  for (Index c = 0; c < mixture.countComponents(); ++c) {
    const VectorXd stddev = mixture.stddevs.col(c);
    const MatrixXd covariance =
        stddev.asDiagonal() * mixture.correlations[static_cast<std::size_t>(c)] * stddev.asDiagonal();
    NormalBelief mode = toSpace(mixture.means.col(c), covariance, space);
    const double overlap = std::log(mixture.weights[c]) + calcLogOverlap(mode, believed);
    if (overlap > best) {
      best = overlap;
      chosen = std::move(mode);
    }
  }
  return chosen;
}

NormalBelief describe(const Estimate& estimate, const TrackSpace& space, const NormalBelief& believed) {
  return estimate.isMultimodal() && estimate.mixture.isGiven()
             ? chooseMode(estimate, space, believed)
             : toSpace(estimate.mean, estimate.calcCovariance(), space);
}

}  // namespace

tracking::Measurement makeTrackMeasurement(const Estimate& estimate, const TrackSpace& space,
                                           const NormalBelief& prior, const NormalBelief& believed) {
  constexpr double kHardly = 1.0 / (kUninformativeShare * kUninformativeShare) - 1.0;
  constexpr double kNothing = 1e12, kSaysNothing = 1e4;  // prior variances
  const NormalBelief posterior = describe(estimate, space, believed);
  const Index p = space.count();
  // in coordinates in which the prior is of unit variance: information = inverse of the posterior's - 1
  const linalg::Cholesky unit = linalg::calcCholesky(prior.covariance);
  const MatrixXd half = linalg::solveLower(unit.lower, posterior.covariance);
  const MatrixXd whitened = linalg::solveLower(unit.lower, half.transpose());
  const linalg::SymmetricEigen eigen = linalg::calcSymmetricEigen(0.5 * (whitened + whitened.transpose()));
  const MatrixXd directions =
      linalg::solveLower(unit.lower, MatrixXd::Identity(p, p)).transpose() * eigen.vectors;
  const VectorXd off =
      eigen.vectors.transpose() * linalg::solveLower(unit.lower, posterior.mean - prior.mean);
  tracking::Measurement measurement;
  measurement.rows.resize(p, p);
  measurement.values.resize(p);
  MatrixXd covariance = MatrixXd::Zero(p, p);
  Index k = 0;
  for (Index i = 0; i < p; ++i) {
    const double information = 1.0 / std::max(eigen.values[i], 1e-300) - 1.0;
    const VectorXd axis = unit.lower * eigen.vectors.col(i);  // of the parameters
    if (!(information > kHardly)) {
      covariance += kNothing * axis * axis.transpose();
      continue;
    }
    const double root = std::sqrt(information);
    measurement.rows.row(k) = root * directions.col(i).transpose();
    measurement.values[k] = measurement.rows.row(k).dot(prior.mean) + off[i] / (eigen.values[i] * root);
    covariance += axis * axis.transpose() / information;
    ++k;
  }
  measurement.rows.conservativeResize(k, p);
  measurement.values.conservativeResize(k);
  measurement.variances = covariance.diagonal();
  for (double& variance : measurement.variances) {
    variance = variance < kSaysNothing ? variance : std::numeric_limits<double>::infinity();
  }
  return measurement;
}

}  // namespace twinmap
