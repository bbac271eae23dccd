#include "kernels/sparse/sparse_online_predictor.hpp"

#include <algorithm>
#include <cassert>
#include <stdexcept>

#include "kernels/covariance/radial.hpp"
#include "kernels/linalg/flush_denormals.hpp"
#include "kernels/linalg/triangular.hpp"

namespace twinmap::gp {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

void require(bool condition, const char* message) {
  if (!condition) throw std::invalid_argument(std::string("SparseOnlinePredictor: ") + message);
}

MatrixXd padRows(const MatrixXd& matrix, Index rows) {
  MatrixXd padded = MatrixXd::Zero(rows, matrix.cols());
  padded.topRows(matrix.rows()) = matrix;
  return padded;
}

}  // namespace

SparseOnlinePredictor::SparseOnlinePredictor(
    const std::vector<std::shared_ptr<const SparseGaussianProcess>>& processes) {
  require(!processes.empty(), "there are no processes");
  for (const auto& process : processes) {
    require(process != nullptr, "a process is null");
    require(process->getFeatureCount() == processes.front()->getFeatureCount(),
            "the processes differ in their number of features");
    targets_.push_back(makeTarget(*process));
  }
  feature_count_ = processes.front()->getFeatureCount();
}

SparseOnlinePredictor::Target SparseOnlinePredictor::makeTarget(const SparseGaussianProcess& process) {
  const SparseGaussianProcessParts& parts = process.getParts();
  Target target;
  target.structure = parts.structure;
  target.hyperparameters = parts.hyperparameters;
  target.center = parts.center;
  target.inverse_squared_scales = process.getMean().getInverseLengthScales().cwiseAbs2();
  target.size = process.getInducingCount();
  target.samples = linalg::PackedSamples(parts.inducing.colwise() - parts.center);
  target.inducing_factor = linalg::PackedLower(linalg::viewOf(parts.posterior.inducing_factor));
  target.correction_factor = linalg::PackedLower(linalg::viewOf(parts.posterior.correction_factor));
  const Index padding = target.samples.paddedSize();
  target.points = padRows((parts.inducing.colwise() - parts.center).transpose(), padding).transpose();
  target.weights = padRows(parts.posterior.weights, padding);
  target.whitened_basis =
      padRows(parts.posterior.whitened_basis / parts.hyperparameters.noise_stddev, padding);
  target.basis_factor = parts.posterior.basis_factor;
  target.mean_coefficients = parts.posterior.mean_coefficients;
  return target;
}

SparseOnlinePredictor::Workspace::Workspace(const SparseOnlinePredictor& predictor) {
  Index largest = 0;
  Index coefficients = 0;
  for (const Target& target : predictor.targets_) {
    largest = std::max(largest, target.samples.paddedSize());
    coefficients = std::max(coefficients, target.mean_coefficients.size());
  }
  values.mean.setZero(predictor.getTargetCount());
  values.latent_variance.setZero(predictor.getTargetCount());
  values.gradient.setZero(predictor.getFeatureCount(), predictor.getTargetCount());
  point.setZero(predictor.getFeatureCount());
  distances.setZero(largest);
  covariance.setZero(largest);
  weight.setZero(largest);
  error.setZero(coefficients);
}

void SparseOnlinePredictor::predict(const Eigen::Ref<const VectorXd>& x, Workspace& workspace) const {
  assert(x.size() == getFeatureCount());
  const linalg::FlushDenormals flush;
  for (Index t = 0; t < getTargetCount(); ++t) predictTarget(t, x, workspace);
}

void SparseOnlinePredictor::predictTarget(Index index, const Eigen::Ref<const VectorXd>& x,
                                          Workspace& workspace) const {
  const Target& target = targets_[index];
  workspace.point = x - target.center;
  addRadial(target, index, workspace);
  const auto projected = workspace.covariance.head(target.samples.paddedSize());
  double& variance = workspace.values.latent_variance(index);
  target.inducing_factor.solve(workspace.covariance.data());
  variance -= projected.squaredNorm();
  target.correction_factor.solve(workspace.covariance.data());
  variance += projected.squaredNorm();
  addMeanFunction(target, index, workspace);
  variance = std::max(variance, 0.0);
}

// Mean, its gradient and the prior variance of the radial part; leaves k in workspace.covariance.
void SparseOnlinePredictor::addRadial(const Target& target, Index index, Workspace& workspace) {
  const Hyperparameters& h = target.hyperparameters;
  const double variance = h.signal_stddev * h.signal_stddev;
  const Index size = target.samples.paddedSize();
  target.samples.weightedDistances<1>(workspace.point.data(), target.inverse_squared_scales.data(),
                                      workspace.distances.data());
  AlignedColumn covariance(workspace.covariance.data(), size);
  AlignedColumn weight(workspace.weight.data(), size);
  evaluateRadial(target.structure.covariance, h.shape, ConstAlignedColumn(workspace.distances.data(), size),
                 covariance, weight);
  covariance *= variance;
  covariance.tail(size - target.size).setZero();
  weight *= variance * target.weights.array();
  workspace.values.mean(index) = covariance.matrix().dot(target.weights);
  workspace.values.latent_variance(index) = variance;
  auto gradient = workspace.values.gradient.col(index);
  gradient.noalias() = target.points * weight.matrix();
  gradient -= weight.sum() * workspace.point;
  gradient.array() *= target.inverse_squared_scales.array();
}

// Adds h(x)'b to the mean and |R^-1 e|^2 to the variance; workspace.covariance holds L_B^-1 L^-1 k.
void SparseOnlinePredictor::addMeanFunction(const Target& target, Index index, Workspace& workspace) {
  const Index count = target.mean_coefficients.size();
  if (count == 0) return;
  const auto corrected = workspace.covariance.head(target.samples.paddedSize());
  for (Index k = 0; k < count; ++k) {
    const double basis = k == 0 ? 1.0 : workspace.point(k - 1);
    workspace.values.mean(index) += basis * target.mean_coefficients(k);
    workspace.error(k) = basis - target.whitened_basis.col(k).dot(corrected);
  }
  if (count > 1) workspace.values.gradient.col(index) += target.mean_coefficients.tail(count - 1);
  linalg::solveLower(linalg::viewOf(target.basis_factor), workspace.error.data());
  workspace.values.latent_variance(index) += workspace.error.head(count).squaredNorm();
}

}  // namespace twinmap::gp
