#include "kernels/gp/cross_covariance.hpp"

#include "kernels/gp/covariance/radial.hpp"
#include "kernels/linalg/gemm.hpp"

namespace twinmap::gp {

using Eigen::Index;
using Eigen::MatrixXd;

namespace {

// s_l^2 x'z, from inputs multiplied back by their length scales.
void addLinearTerm(const ModelStructure& structure, const Hyperparameters& hyperparameters,
                   const MatrixXd& left, const MatrixXd& right, linalg::View covariance,
                   linalg::GemmScratch& scratch) {
  const Eigen::VectorXd scales = lengthScaleOfFeatures(structure, hyperparameters, left.rows());
  const MatrixXd x = scales.asDiagonal() * left;
  const MatrixXd z = scales.asDiagonal() * right;
  const double variance = hyperparameters.linear_stddev * hyperparameters.linear_stddev;
  linalg::gemm(variance, linalg::viewOf(x).transposed(), linalg::viewOf(z), 1.0, covariance, scratch);
}

}  // namespace

MatrixXd calcCrossCovariance(const ModelStructure& structure, const Hyperparameters& hyperparameters,
                             const MatrixXd& left, const MatrixXd& right, MatrixXd* weights) {
  const Index rows = linalg::padded(left.cols());
  const double variance = hyperparameters.signal_stddev * hyperparameters.signal_stddev;
  MatrixXd covariance = MatrixXd::Zero(rows, right.cols());
  const linalg::View view{covariance.data(), left.cols(), right.cols(), rows};
  linalg::GemmScratch scratch;
  linalg::gemm(-2.0, linalg::viewOf(left).transposed(), linalg::viewOf(right), 0.0, view, scratch);
  Eigen::ArrayXd left_norms = Eigen::ArrayXd::Zero(rows);
  left_norms.head(left.cols()) = left.colwise().squaredNorm().transpose();
  if (weights) {
    weights->resize(left.cols(), right.cols());
  }
  Eigen::ArrayXd q(rows);
  Eigen::ArrayXd weight(rows);
  for (Index j = 0; j < right.cols(); ++j) {
    AlignedColumn column(covariance.col(j).data(), rows);
    q = (column + left_norms + right.col(j).squaredNorm()).max(0.0);
    evaluateRadial(structure.covariance, hyperparameters.shape, ConstAlignedColumn(q.data(), rows), column,
                   AlignedColumn(weight.data(), rows));
    column *= variance;
    if (weights) {
      weights->col(j) = variance * weight.head(left.cols());
    }
  }
  if (structure.linear_term) {
    addLinearTerm(structure, hyperparameters, left, right, view, scratch);
  }
  covariance.conservativeResize(left.cols(), Eigen::NoChange);
  return covariance;
}

Eigen::VectorXd calcPriorVariance(const ModelStructure& structure, const Hyperparameters& hyperparameters,
                                  const MatrixXd& inputs) {
  const double variance = hyperparameters.signal_stddev * hyperparameters.signal_stddev;
  Eigen::VectorXd prior = Eigen::VectorXd::Constant(inputs.cols(), variance);
  if (!structure.linear_term) {
    return prior;
  }
  const Eigen::VectorXd scales = lengthScaleOfFeatures(structure, hyperparameters, inputs.rows());
  const double linear_variance = hyperparameters.linear_stddev * hyperparameters.linear_stddev;
  for (Index i = 0; i < inputs.cols(); ++i) {
    prior(i) += linear_variance * inputs.col(i).cwiseProduct(scales).squaredNorm();
  }
  return prior;
}

Eigen::VectorXd lengthScaleOfFeatures(const ModelStructure& structure, const Hyperparameters& hyperparameters,
                                      Index feature_count) {
  if (structure.length_scale_groups.empty()) {
    return Eigen::VectorXd::Constant(feature_count, hyperparameters.length_scales(0));
  }
  Eigen::VectorXd scales(feature_count);
  for (Index f = 0; f < feature_count; ++f) {
    scales(f) = hyperparameters.length_scales(structure.length_scale_groups[f]);
  }
  return scales;
}

}  // namespace twinmap::gp
