#include "framework/estimation/trained/residual_space.hpp"

#include "framework/data/noise/noise_whitener.hpp"
#include "framework/data/reduction/principal_components.hpp"
#include "framework/estimation/surrogate/feature_windows.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// Appends the components of what the scores leave of one window, `rest` (k x n).
void addUnmodelled(const FeatureWindow& rows, const MatrixXd& rest, ResidualSpace& space) {
  const PrincipalComponents components = calcPrincipalComponents(rest(rows, Eigen::all));
  const Index count = (components.variances.array() > kSmallestStddev * kSmallestStddev).count();
  const Index before = space.unmodelled.cols();
  space.unmodelled.conservativeResize(rest.rows(), before + count);
  space.unmodelled.rightCols(count).setZero();
  space.unmodelled(rows, Eigen::lastN(count)) = components.directions.leftCols(count);
  space.unmodelled_stddev.conservativeResize(before + count);
  space.unmodelled_stddev.tail(count) = components.variances.head(count).cwiseSqrt();
}

}  // namespace

void ResidualSpace::calcResidual(const VectorXd& centered, const VectorXd& innovation,
                                 VectorXd& residual) const {
  if (whitener.cols() == 1) {
    residual = whitener.col(0).cwiseProduct(centered);
  } else {
    residual.noalias() = whitener * centered;
  }
  const VectorXd excess = innovation - directions.transpose() * residual;
  residual.noalias() += directions * excess;
  const VectorXd moved = unmodelled.transpose() * residual;
  const auto shrinkage = (1.0 + unmodelled_stddev.array().square()).rsqrt();
  residual.noalias() += unmodelled * (moved.array() * (shrinkage - 1.0)).matrix();
}

ResidualSpace fitResidualSpace(const std::vector<FeatureInfo>& infos, const MatrixXd& clean_features,
                               const NoiseCovariance& noise_covariance, const ForwardSurrogate& surrogate) {
  const NoiseWhitener noise(noise_covariance);
  ResidualSpace space;
  space.whitener = noise.isDiagonal() ? MatrixXd(noise.getScale()) : noise.makeMatrix();
  // projection = V' W and W C W' = 1
  space.directions = noise.apply(noise_covariance * surrogate.projection.transpose());
  const MatrixXd whitened = noise.apply(clean_features.colwise() - surrogate.center);
  const MatrixXd rest = whitened - space.directions * (space.directions.transpose() * whitened);
  space.unmodelled.resize(whitened.rows(), 0);
  const bool by_feature = whitened.rows() == static_cast<Index>(infos.size());
  for (const FeatureWindow& rows :
       by_feature ? makeFeatureWindows(infos) : makeWindowsInOrder(whitened.rows())) {
    addUnmodelled(rows, rest, space);
  }
  return space;
}

}  // namespace twinmap
