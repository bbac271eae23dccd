#include "kernels/gp/gaussian_process.hpp"

#include <cmath>
#include <stdexcept>
#include <utility>

#include "kernels/gp/cross_covariance.hpp"
#include "kernels/gp/training_set.hpp"
#include "kernels/linalg/flush_denormals.hpp"
#include "kernels/linalg/triangular.hpp"

namespace twinmap::gp {

using Eigen::Index;
using Eigen::MatrixXd;

namespace {

constexpr Index kPredictionBlock = 256;  // points predicted together: the block of V stays in cache

void require(bool condition, const char* message) {
  if (!condition) throw std::invalid_argument(std::string("GaussianProcess: ") + message);
}

void check_parts(const GaussianProcessParts& parts) {
  require(parts.inputs != nullptr && parts.inputs->size() > 0, "there are no training inputs");
  const Index n = parts.inputs->cols();
  check_structure(parts.structure, parts.inputs->rows());
  check_hyperparameters(parts.structure, parts.hyperparameters);
  check_inputs(*parts.inputs, "GaussianProcess inputs");
  require(parts.alpha.size() == n, "alpha must have one entry per training sample");
  require(parts.factor.rows() == n && parts.factor.cols() == n, "the factor must be n x n");
  require(parts.mean_coefficients.size() == mean_coefficient_count(parts.structure, parts.inputs->rows()),
          "the number of mean coefficients does not fit the mean function");
  require(parts.alpha.allFinite() && parts.factor.allFinite() && parts.mean_coefficients.allFinite(),
          "alpha, factor and mean coefficients must be finite");
  require((parts.factor.diagonal().array() > 0.0).all(), "the factor's diagonal must be positive");
}

// R, the lower Cholesky factor of V'V.
MatrixXd calc_basis_factor(const MatrixXd& whitened_basis, linalg::TriangularScratch& scratch) {
  MatrixXd normal = MatrixXd::Zero(whitened_basis.cols(), whitened_basis.cols());
  if (normal.size() == 0) return normal;
  const linalg::ConstView basis = linalg::view_of(whitened_basis);
  linalg::gemm(1.0, basis.transposed(), basis, 0.0, linalg::view_of(normal), scratch.gemm());
  require(linalg::factorize_cholesky(linalg::view_of(normal), scratch), "the mean's basis is rank deficient");
  return normal;
}

}  // namespace

GaussianProcess::GaussianProcess(GaussianProcessParts parts) : parts_(std::move(parts)) {
  check_parts(parts_);
  const MatrixXd& inputs = *parts_.inputs;
  center_ = calc_center(inputs);
  inverse_length_scales_ =
      length_scale_of_features(parts_.structure, parts_.hyperparameters, inputs.rows()).cwiseInverse();
  const MatrixXd centered = inputs.colwise() - center_;
  scaled_inputs_ = inverse_length_scales_.asDiagonal() * centered;
  whitened_basis_ = calc_mean_basis(parts_.structure.mean, centered);
  for (Index k = 0; k < whitened_basis_.cols(); ++k) {
    linalg::solve_lower(linalg::view_of(std::as_const(parts_.factor)), whitened_basis_.col(k).data());
  }
  linalg::TriangularScratch scratch(whitened_basis_.cols());
  basis_factor_ = calc_basis_factor(whitened_basis_, scratch);
}

Prediction GaussianProcess::predict(const Eigen::Ref<const MatrixXd>& inputs) const {
  if (inputs.rows() != feature_count()) {
    throw std::invalid_argument("GaussianProcess::predict: the inputs have " + std::to_string(inputs.rows()) +
                                " features; the process was trained on " + std::to_string(feature_count()));
  }
  check_inputs(inputs, "GaussianProcess::predict inputs");
  const linalg::FlushDenormals flush;
  Prediction prediction;
  prediction.mean.resize(inputs.cols());
  prediction.latent_variance.resize(inputs.cols());
  for (Index first = 0; first < inputs.cols(); first += kPredictionBlock) {
    const Index count = std::min(kPredictionBlock, inputs.cols() - first);
    predict_block(inputs.middleCols(first, count), first, prediction);
  }
  const double noise_variance = parts_.hyperparameters.noise_stddev * parts_.hyperparameters.noise_stddev;
  prediction.variance = prediction.latent_variance.array() + noise_variance;
  return prediction;
}

void GaussianProcess::predict_block(const Eigen::Ref<const MatrixXd>& inputs, Index first,
                                    Prediction& prediction) const {
  const Index m = inputs.cols();
  const MatrixXd centered = inputs.colwise() - center_;
  const MatrixXd scaled = inverse_length_scales_.asDiagonal() * centered;
  MatrixXd covariance =
      calc_cross_covariance(parts_.structure, parts_.hyperparameters, scaled, scaled_inputs_);
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(m);
  for (Index j = 0; j < sample_count(); ++j) mean += parts_.alpha(j) * covariance.col(j);
  Eigen::VectorXd variance = calc_prior_variance(parts_.structure, parts_.hyperparameters, scaled);
  linalg::TriangularScratch scratch(m);
  linalg::solve_transposed_from_right(linalg::view_of(parts_.factor), linalg::view_of(covariance), scratch);
  for (Index j = 0; j < sample_count(); ++j) variance -= covariance.col(j).cwiseAbs2();
  if (whitened_basis_.cols() > 0) {
    MatrixXd error = calc_mean_basis(parts_.structure.mean, centered);  // e' as rows
    for (Index k = 0; k < error.cols(); ++k) mean += parts_.mean_coefficients(k) * error.col(k);
    linalg::gemm(-1.0, linalg::view_of(std::as_const(covariance)), linalg::view_of(whitened_basis_), 1.0,
                 linalg::view_of(error), scratch.gemm());
    linalg::solve_transposed_from_right(linalg::view_of(basis_factor_), linalg::view_of(error), scratch);
    for (Index k = 0; k < error.cols(); ++k) variance += error.col(k).cwiseAbs2();
  }
  prediction.mean.segment(first, m) = mean;
  prediction.latent_variance.segment(first, m) = variance.cwiseMax(0.0);
}

}  // namespace twinmap::gp
