#include "kernels/gp/gaussian_process.hpp"

#include <stdexcept>
#include <utility>

#include "kernels/gp/training_set.hpp"
#include "kernels/linalg/flush_denormals.hpp"
#include "kernels/linalg/triangular.hpp"

namespace twinmap::gp {

using Eigen::Index;
using Eigen::MatrixXd;

namespace {

constexpr Index kPredictionBlock = 256;  // points predicted together: the block of V stays in cache

void requirePart(bool condition, const char* message) {
  if (!condition) {
    throw std::invalid_argument(std::string("GaussianProcess: ") + message);
  }
}

void checkParts(const GaussianProcessParts& parts) {
  requirePart(parts.inputs != nullptr && parts.inputs->size() > 0, "there are no training inputs");
  const Index n = parts.inputs->cols();
  checkStructure(parts.structure, parts.inputs->rows());
  checkHyperparameters(parts.structure, parts.hyperparameters);
  checkInputs(*parts.inputs, "GaussianProcess inputs");
  requirePart(parts.alpha.size() == n, "alpha must have one entry per training sample");
  requirePart(parts.factor.rows() == n && parts.factor.cols() == n, "the factor must be n x n");
  requirePart(
      parts.mean_coefficients.size() == getMeanCoefficientCount(parts.structure, parts.inputs->rows()),
      "the number of mean coefficients does not fit the mean function");
  requirePart(parts.alpha.allFinite() && parts.factor.allFinite() && parts.mean_coefficients.allFinite(),
              "alpha, factor and mean coefficients must be finite");
  requirePart((parts.factor.diagonal().array() > 0.0).all(), "the factor's diagonal must be positive");
}

// R, the lower Cholesky factor of V'V.
MatrixXd calcBasisFactor(const MatrixXd& whitened_basis, linalg::TriangularScratch& scratch) {
  MatrixXd normal = MatrixXd::Zero(whitened_basis.cols(), whitened_basis.cols());
  if (normal.size() == 0) {
    return normal;
  }
  const linalg::ConstView basis = linalg::viewOf(whitened_basis);
  linalg::gemm(1.0, basis.transposed(), basis, 0.0, linalg::viewOf(normal), scratch.gemm());
  requirePart(linalg::factorizeCholesky(linalg::viewOf(normal), scratch),
              "the mean's basis is rank deficient");
  return normal;
}

}  // namespace

GaussianProcess::GaussianProcess(GaussianProcessParts parts) : parts_(std::move(parts)) {
  checkParts(parts_);
  const MatrixXd& inputs = *parts_.inputs;
  expansion_ = KernelExpansion(parts_.structure, parts_.hyperparameters, calcCenter(inputs), inputs,
                               parts_.alpha, parts_.mean_coefficients);
  whitened_basis_ = calcMeanBasis(parts_.structure.mean, expansion_.calcCentered(inputs));
  for (Index k = 0; k < whitened_basis_.cols(); ++k) {
    linalg::solveLower(linalg::viewOf(std::as_const(parts_.factor)), whitened_basis_.col(k).data());
  }
  linalg::TriangularScratch scratch(whitened_basis_.cols());
  basis_factor_ = calcBasisFactor(whitened_basis_, scratch);
}

Prediction GaussianProcess::predict(const Eigen::Ref<const MatrixXd>& inputs) const {
  if (inputs.rows() != getFeatureCount()) {
    throw std::invalid_argument("GaussianProcess::predict: the inputs have " + std::to_string(inputs.rows()) +
                                " features; the process was trained on " + std::to_string(getFeatureCount()));
  }
  checkInputs(inputs, "GaussianProcess::predict inputs");
  const linalg::FlushDenormals flush;
  Prediction prediction;
  prediction.mean.resize(inputs.cols());
  prediction.latent_variance.resize(inputs.cols());
  for (Index first = 0; first < inputs.cols(); first += kPredictionBlock) {
    const Index count = std::min(kPredictionBlock, inputs.cols() - first);
    predictBlock(inputs.middleCols(first, count), first, prediction);
  }
  const double noise_variance = parts_.hyperparameters.noise_stddev * parts_.hyperparameters.noise_stddev;
  prediction.variance = prediction.latent_variance.array() + noise_variance;
  return prediction;
}

void GaussianProcess::predictBlock(const Eigen::Ref<const MatrixXd>& inputs, Index first,
                                   Prediction& prediction) const {
  const Index m = inputs.cols();
  const MatrixXd centered = expansion_.calcCentered(inputs);
  MatrixXd covariance = expansion_.calcCovariance(centered);
  prediction.mean.segment(first, m) = expansion_.calcMean(centered, covariance);
  Eigen::VectorXd variance = expansion_.calcPriorVariance(centered);
  linalg::TriangularScratch scratch(m);
  linalg::solveTransposedFromRight(linalg::viewOf(parts_.factor), linalg::viewOf(covariance), scratch);
  for (Index j = 0; j < getSampleCount(); ++j) {
    variance -= covariance.col(j).cwiseAbs2();
  }
  if (whitened_basis_.cols() > 0) {
    MatrixXd error = calcMeanBasis(parts_.structure.mean, centered);  // e' as rows
    linalg::gemm(-1.0, linalg::viewOf(std::as_const(covariance)), linalg::viewOf(whitened_basis_), 1.0,
                 linalg::viewOf(error), scratch.gemm());
    linalg::solveTransposedFromRight(linalg::viewOf(basis_factor_), linalg::viewOf(error), scratch);
    for (Index k = 0; k < error.cols(); ++k) {
      variance += error.col(k).cwiseAbs2();
    }
  }
  prediction.latent_variance.segment(first, m) = variance.cwiseMax(0.0);
}

}  // namespace twinmap::gp
