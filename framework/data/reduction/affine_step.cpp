#include "framework/data/reduction/affine_step.hpp"

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

}  // namespace twinmap
