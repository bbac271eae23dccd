#include "kernels/gp/sparse/sparse_gaussian_process.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "kernels/gp/training_set.hpp"
#include "kernels/linalg/flush_denormals.hpp"
#include "kernels/linalg/triangular.hpp"

namespace twinmap::gp {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using linalg::viewOf;

namespace {

constexpr Index kSparseBlock = 256;  // points predicted together: their covariances stay in cache

void requireSparsePart(bool condition, const char* message) {
  if (!condition) {
    throw std::invalid_argument(std::string("SparseGaussianProcess: ") + message);
  }
}

void checkSparseParts(const SparseGaussianProcessParts& parts) {
  const VariationalPosterior& posterior = parts.posterior;
  const Index m = parts.inducing.cols(), d = parts.inducing.rows();
  const Index p = getMeanCoefficientCount(parts.structure, d);
  requireSparsePart(m > 0 && d > 0, "there are no inducing inputs");
  checkStructure(parts.structure, d);
  checkHyperparameters(parts.structure, parts.hyperparameters);
  checkInputs(parts.inducing, "SparseGaussianProcess inducing inputs");
  requireSparsePart(parts.center.size() == d && parts.center.allFinite(),
                    "the centre needs one number per feature");
  requireSparsePart(posterior.inducing_factor.rows() == m && posterior.inducing_factor.cols() == m &&
                        posterior.correction_factor.rows() == m && posterior.correction_factor.cols() == m,
                    "the factors must be m x m");
  requireSparsePart(posterior.weights.size() == m && posterior.mean_coefficients.size() == p &&
                        posterior.whitened_basis.rows() == m && posterior.whitened_basis.cols() == p &&
                        posterior.basis_factor.rows() == p && posterior.basis_factor.cols() == p,
                    "weights or mean do not fit the inducing inputs");
  requireSparsePart(posterior.inducing_factor.allFinite() && posterior.correction_factor.allFinite() &&
                        posterior.weights.allFinite() && posterior.whitened_basis.allFinite() &&
                        posterior.basis_factor.allFinite() && posterior.mean_coefficients.allFinite(),
                    "every number must be finite");
}

VectorXd sumVariance(const SparseProjection& projection) {
  VectorXd variance = projection.missed_variance;
  for (Index j = 0; j < projection.corrected.cols(); ++j) {
    variance += projection.corrected.col(j).cwiseAbs2();
  }
  for (Index k = 0; k < projection.basis_error.cols(); ++k) {
    variance += projection.basis_error.col(k).cwiseAbs2();
  }
  return variance.cwiseMax(0.0);
}

}  // namespace

SparseGaussianProcess::SparseGaussianProcess(SparseGaussianProcessParts parts) : parts_(std::move(parts)) {
  checkSparseParts(parts_);
  expansion_ = KernelExpansion(parts_.structure, parts_.hyperparameters, parts_.center, parts_.inducing,
                               parts_.posterior.weights, parts_.posterior.mean_coefficients);
}

Prediction SparseGaussianProcess::predict(const Eigen::Ref<const MatrixXd>& inputs) const {
  requireSparsePart(inputs.rows() == getFeatureCount(),
                    "the inputs have another number of features than the process");
  checkInputs(inputs, "SparseGaussianProcess::predict inputs");
  const linalg::FlushDenormals flush;
  Prediction prediction;
  prediction.mean.resize(inputs.cols());
  prediction.latent_variance.resize(inputs.cols());
  for (Index first = 0; first < inputs.cols(); first += kSparseBlock) {
    const Index count = std::min(kSparseBlock, inputs.cols() - first);
    const SparseProjection block = project(inputs.middleCols(first, count));
    prediction.mean.segment(first, count) = block.mean;
    prediction.latent_variance.segment(first, count) = sumVariance(block);
  }
  const double noise_stddev = parts_.hyperparameters.noise_stddev;
  prediction.variance = prediction.latent_variance.array() + noise_stddev * noise_stddev;
  return prediction;
}

SparseProjection SparseGaussianProcess::project(const Eigen::Ref<const MatrixXd>& inputs) const {
  const VariationalPosterior& posterior = parts_.posterior;
  const MatrixXd centered = expansion_.calcCentered(inputs);
  SparseProjection result;
  MatrixXd& a = result.corrected;
  a = expansion_.calcCovariance(centered);
  result.mean = expansion_.calcMean(centered, a);
  result.missed_variance = expansion_.calcPriorVariance(centered);
  linalg::TriangularScratch scratch(inputs.cols());
  linalg::solveTransposedFromRight(viewOf(posterior.inducing_factor), viewOf(a), scratch);
  for (Index j = 0; j < getInducingCount(); ++j) {
    result.missed_variance -= a.col(j).cwiseAbs2();
  }
  linalg::solveTransposedFromRight(viewOf(posterior.correction_factor), viewOf(a), scratch);
  if (posterior.mean_coefficients.size() == 0) {
    return result;
  }
  MatrixXd& error = result.basis_error;
  error = calcMeanBasis(parts_.structure.mean, centered);
  linalg::gemm(-1.0 / parts_.hyperparameters.noise_stddev, viewOf(std::as_const(a)),
               viewOf(posterior.whitened_basis), 1.0, viewOf(error), scratch.gemm());
  linalg::solveTransposedFromRight(viewOf(posterior.basis_factor), viewOf(error), scratch);
  return result;
}

}  // namespace twinmap::gp
