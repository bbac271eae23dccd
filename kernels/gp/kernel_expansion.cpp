#include "kernels/gp/kernel_expansion.hpp"

#include <algorithm>

#include "kernels/gp/cross_covariance.hpp"
#include "kernels/gp/training_set.hpp"
#include "kernels/linalg/flush_denormals.hpp"

namespace twinmap::gp {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr Index kInputBlock = 256;  // inputs taken together: memory for 256 n covariances instead of m n

}  // namespace

KernelExpansion::KernelExpansion(const ModelStructure& structure, const Hyperparameters& hyperparameters,
                                 const VectorXd& center, const MatrixXd& points, const VectorXd& weights,
                                 const VectorXd& mean_coefficients)
    : structure_(structure),
      hyperparameters_(hyperparameters),
      center_(center),
      inverse_length_scales_(lengthScaleOfFeatures(structure, hyperparameters, points.rows()).cwiseInverse()),
      scaled_points_(inverse_length_scales_.asDiagonal() * (points.colwise() - center)),
      weights_(weights),
      mean_coefficients_(mean_coefficients) {}

MatrixXd KernelExpansion::calcCentered(const Eigen::Ref<const MatrixXd>& inputs) const {
  return inputs.colwise() - center_;
}

MatrixXd KernelExpansion::calcCovariance(const MatrixXd& centered) const {
  return calcCrossCovariance(structure_, hyperparameters_, inverse_length_scales_.asDiagonal() * centered,
                             scaled_points_);
}

VectorXd KernelExpansion::calcPriorVariance(const MatrixXd& centered) const {
  return gp::calcPriorVariance(structure_, hyperparameters_, inverse_length_scales_.asDiagonal() * centered);
}

VectorXd KernelExpansion::calcMean(const MatrixXd& centered, const MatrixXd& covariance) const {
  VectorXd mean = VectorXd::Zero(centered.cols());
  for (Index j = 0; j < weights_.size(); ++j) {
    mean += weights_(j) * covariance.col(j);
  }
  const MatrixXd basis = calcMeanBasis(structure_.mean, centered);
  for (Index k = 0; k < basis.cols(); ++k) {
    mean += mean_coefficients_(k) * basis.col(k);
  }
  return mean;
}

VectorXd KernelExpansion::predictMean(const Eigen::Ref<const MatrixXd>& inputs) const {
  checkInputs(inputs, "predictMean inputs");
  const linalg::FlushDenormals flush;
  VectorXd mean(inputs.cols());
  for (Index first = 0; first < inputs.cols(); first += kInputBlock) {
    const Index count = std::min(kInputBlock, inputs.cols() - first);
    const MatrixXd centered = calcCentered(inputs.middleCols(first, count));
    mean.segment(first, count) = calcMean(centered, calcCovariance(centered));
  }
  return mean;
}

MatrixXd KernelExpansion::predictMeanGradient(const Eigen::Ref<const MatrixXd>& inputs) const {
  checkInputs(inputs, "predictMeanGradient inputs");
  const linalg::FlushDenormals flush;
  MatrixXd gradient(inputs.rows(), inputs.cols());
  for (Index first = 0; first < inputs.cols(); first += kInputBlock) {
    const Index count = std::min(kInputBlock, inputs.cols() - first);
    gradient.middleCols(first, count) = calcGradient(calcCentered(inputs.middleCols(first, count)));
  }
  return gradient;
}

// dcov/dx = dcov/dq 2 (x - z) / l^2 = -W (x - z) / l^2, with calcCrossCovariance's weights W; the linear
// term s_l^2 z'x adds s_l^2 z.
MatrixXd KernelExpansion::calcGradient(const MatrixXd& centered) const {
  const MatrixXd scaled = inverse_length_scales_.asDiagonal() * centered;
  MatrixXd radial;
  calcCrossCovariance(structure_, hyperparameters_, scaled, scaled_points_, &radial);
  radial = radial * weights_.asDiagonal();
  MatrixXd gradient = scaled_points_ * radial.transpose() - scaled * radial.rowwise().sum().asDiagonal();
  gradient = inverse_length_scales_.asDiagonal() * gradient;
  if (structure_.linear_term) {
    const VectorXd scales = inverse_length_scales_.cwiseInverse();
    const double variance = hyperparameters_.linear_stddev * hyperparameters_.linear_stddev;
    gradient.colwise() += variance * scales.cwiseProduct(scaled_points_ * weights_);
  }
  if (structure_.mean == MeanFunction::kLinear) {
    gradient.colwise() += mean_coefficients_.tail(centered.rows());
  }
  return gradient;
}

}  // namespace twinmap::gp
