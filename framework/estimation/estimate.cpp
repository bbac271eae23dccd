#include "framework/estimation/estimate.hpp"

#include <algorithm>

#include "framework/estimation/levels.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

Intervals clampTo(double lower, double upper, Intervals intervals) {
  for (auto& [from, to] : intervals) {
    from = std::clamp(from, lower, upper);
    to = std::clamp(to, lower, upper);
  }
  return intervals;
}

}  // namespace

const char* toString(EstimationMethod method) {
  switch (method) {
    case EstimationMethod::kEstimator:
      return "estimator";
    case EstimationMethod::kPosterior:
      return "posterior";
    case EstimationMethod::kRefined:
      break;
  }
  return "refined";
}

MatrixXd Estimate::calcCovariance() const {
  const MatrixXd covariance = correlation.cwiseProduct(stddev * stddev.transpose());
  return 0.5 * (covariance + covariance.transpose());  // correlations are symmetric to rounding only
}

bool Estimate::isMultimodal() const {
  return draws.isGiven() ? mixture.countComponents() > 1 : twinmap::isMultimodal(mixture);
}

Intervals Estimate::findIntervals(Index parameter, Coverage coverage) const {
  const IntervalFactor both = interval_factors.get(parameter);
  const double factor = coverage == Coverage::k50 ? both.of50 : both.of95;
  if (mixture.isGiven()) {
    Intervals intervals = findWithin(takeMarginal(mixture, parameter), factor);
    if (!draws.isGiven()) {
      return intervals;
    }
    if (intervals.size() > 1) {
      return clampTo(draws.lower[parameter], draws.upper[parameter], std::move(intervals));
    }
  }
  if (draws.isGiven()) {
    return {draws.findInterval(parameter, coverage == Coverage::k50 ? 0.5 : 0.95)};
  }
  const double half_width = factor * stddev[parameter];
  const Intervals intervals{{mean[parameter] - half_width, mean[parameter] + half_width}};
  return limits.lower.size() > 0 ? clampTo(limits.lower[parameter], limits.upper[parameter], intervals)
                                 : intervals;
}

Bounds95 Estimate::calcBounds95() const {
  Bounds95 bounds{mean, mean};
  for (Index p = 0; p < mean.size(); ++p) {
    const Intervals intervals = findIntervals(p, Coverage::k95);
    bounds.lower[p] = intervals.front().first;
    bounds.upper[p] = intervals.back().second;
  }
  return bounds;
}

VectorXd Estimate::calcRatioToLimit() const {
  return limit_stddev.size() > 0 ? VectorXd(stddev.cwiseQuotient(limit_stddev)) : VectorXd();
}

Estimate Estimate::takeLikeliest() const {
  if (!mixture.isGiven()) {
    return {mean, stddev};
  }
  const Index best = findLikeliest(mixture);
  return {mixture.means.col(best), mixture.stddevs.col(best)};
}

MatrixXd Estimates::repeat(const MatrixXd& values) const {
  if (repeated.empty() || values.cols() == 0) {
    return values;
  }
  MatrixXd all(values.rows(), values.cols() + static_cast<Index>(repeated.size()));
  all << values, values(Eigen::all, repeated);
  return all;
}

void convert(const VectorXd& center, const VectorXd& unit, const VectorXd& stddev_scale,
             Estimates& estimates) {
  estimates.mean = (unit.asDiagonal() * estimates.mean).colwise() + center;
  estimates.stddev = stddev_scale.cwiseProduct(unit).asDiagonal() * estimates.stddev;
  for (std::size_t i = 0; i < estimates.mixtures.size(); ++i) {
    convert(center, unit, stddev_scale, estimates.mixtures[i]);
    const MatrixXd covariance = calcCovariance(estimates.mixtures[i]);
    estimates.stddev.col(static_cast<Index>(i)) = covariance.diagonal().cwiseSqrt();
    estimates.correlations[i] = calcCorrelation(covariance);
  }
}

void shrinkToBounds(const VectorXd& center, const VectorXd& half_width, Eigen::Ref<VectorXd> mean,
                    Eigen::Ref<VectorXd> stddev) {
  for (Index p = 0; p < center.size(); ++p) {
    if (stddev[p] > half_width[p]) {
      mean[p] = center[p] + half_width[p] / stddev[p] * (mean[p] - center[p]);
      stddev[p] = half_width[p];
    }
  }
}

void shrinkToBounds(const VectorXd& center, const VectorXd& half_width, Estimates& estimates) {
  for (std::size_t i = 0; i < estimates.mixtures.size(); ++i) {
    shrinkToBounds(center, half_width, estimates.stddev.col(static_cast<Index>(i)), estimates.mixtures[i]);
  }
  for (Index i = 0; i < estimates.mean.cols(); ++i) {
    shrinkToBounds(center, half_width, estimates.mean.col(i), estimates.stddev.col(i));
  }
}

VectorXd calcDepths(const Estimates& estimates, const MatrixXd& truth, Index parameter) {
  if (estimates.mixtures.empty()) {
    return (estimates.mean - truth).row(parameter).cwiseQuotient(estimates.stddev.row(parameter)).cwiseAbs();
  }
  VectorXd depths(truth.cols());
  for (Index i = 0; i < depths.size(); ++i) {
    const Mixture& mixture = estimates.mixtures[static_cast<std::size_t>(i)];
    depths[i] = calcDepth(takeMarginal(mixture, parameter), truth(parameter, i));
  }
  return depths;
}

IntervalFactors calcIntervalFactors(const Estimates& estimates, const MatrixXd& truth, int draws) {
  constexpr double kMin = 400.0;
  const double samples = static_cast<double>(truth.cols()) / draws;
  if (samples < kMin) {
    return {};
  }
  IntervalFactors factors{MatrixXd(truth.rows(), 1), MatrixXd(truth.rows(), 1)};
  for (Index p = 0; p < truth.rows(); ++p) {
    factors.set(p, 0, calcIntervalFactor(calcDepths(estimates, truth, p), samples));
  }
  return (factors.of95.array() == kNormal95).all() ? IntervalFactors{} : factors;
}

MatrixXd calcCorrelation(const MatrixXd& covariance) {
  const VectorXd inverse_stddev = covariance.diagonal().cwiseSqrt().cwiseInverse();
  return inverse_stddev.asDiagonal() * covariance * inverse_stddev.asDiagonal();
}

namespace {

Eigen::MatrixXd makePositiveDefinite(const Eigen::MatrixXd& correlation) {
  const double least = linalg::calcSymmetricEigenvalues(correlation)[0];
  const double weight = std::max(0.0, (kSameNumber - least) / (1.0 - least));
  Eigen::MatrixXd shrunk = (1.0 - weight) * correlation;
  shrunk.diagonal().setOnes();
  return shrunk;
}

}  // namespace

Eigen::MatrixXd calcResidualCorrelation(const Eigen::MatrixXd& standardised_residuals) {
  const Eigen::VectorXd norms = standardised_residuals.rowwise().norm();
  const Eigen::VectorXd inverse = (norms.array() > 0.0).select(norms.cwiseInverse(), 0.0);
  const Eigen::MatrixXd unit = inverse.asDiagonal() * standardised_residuals;
  Eigen::MatrixXd correlation = unit * unit.transpose();
  correlation.diagonal().setOnes();
  return correlation.rows() < 2 ? correlation : makePositiveDefinite(correlation);
}

}  // namespace twinmap
