#include "framework/data/reduction/affine_step.hpp"

#include <stdexcept>

#include "framework/data/noise/noise_whitener.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd AffineStep::apply(const MatrixXd& features) const {
  return applyLinear(features.colwise() - offset);
}

MatrixXd AffineStep::applyLinear(const MatrixXd& differences) const {
  const MatrixXd scaled = differences.array().colwise() / scale.array();
  if (projection.size() == 0) {
    return scaled;
  }
  return projection * scaled;
}

NoiseCovariance AffineStep::applyToCovariance(const NoiseCovariance& covariance) const {
  if (!covariance.isDiagonal()) {
    return applyLinear(applyLinear(covariance.toMatrix()).transpose());
  }
  const VectorXd scaled = covariance.diagonal().cwiseQuotient(scale);
  if (projection.size() == 0) {
    return NoiseCovariance::makeIndependent(scaled.cwiseQuotient(scale));
  }
  return applyLinear(scaled.asDiagonal() * projection.transpose());
}

AffineStep makeProjection(const VectorXd& offset, const MatrixXd& projection) {
  return {offset, VectorXd::Ones(projection.cols()), projection};
}

AffineStep makeSelection(const std::vector<Index>& selected, Index count) {
  MatrixXd projection = MatrixXd::Zero(static_cast<Index>(selected.size()), count);
  for (std::size_t row = 0; row < selected.size(); ++row) {
    projection(static_cast<Index>(row), selected[row]) = 1.0;
  }
  return makeProjection(VectorXd::Zero(count), projection);
}

AffineStep fitZScore(const MatrixXd& features) {
  const VectorXd mean = features.rowwise().mean();
  const MatrixXd centered = features.colwise() - mean;
  const VectorXd stddev =
      (centered.rowwise().squaredNorm() / (static_cast<double>(features.cols()) - 1.0)).cwiseSqrt();
  constexpr double kRounding = 1e-14;  // a feature that varies by less relative to its mean is constant
  const Eigen::ArrayXd smallest = kRounding * mean.array().abs();
  return {mean, (stddev.array() > smallest).select(stddev, 1.0), {}};
}

AffineStep fitWhiten(const WhitenSpec& spec, const NoiseCovariance& noise_covariance) {
  const VectorXd& noise_variance = noise_covariance.diagonal();
  if (!(noise_variance.minCoeff() > 0.0)) {
    throw std::invalid_argument("whiten: the noise of a feature is 0");
  }
  const VectorXd zero = VectorXd::Zero(noise_variance.size());
  if (spec.by == WhitenBy::kStddev || noise_covariance.isDiagonal()) {
    return {zero, noise_variance.cwiseSqrt(), {}};
  }
  return makeProjection(zero, NoiseWhitener(noise_covariance).makeMatrix());
}

}  // namespace twinmap
