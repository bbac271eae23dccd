#include "framework/data/reduction/scaling_steps.hpp"

#include <stdexcept>

#include "framework/data/noise/noise_whitener.hpp"

namespace twinmap {

using Eigen::MatrixXd;
using Eigen::VectorXd;

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
