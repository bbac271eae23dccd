#include "kernels/gp/marginal_likelihood.hpp"

#include <cmath>
#include <limits>

#include "kernels/covariance/columns.hpp"
#include "kernels/covariance/radial.hpp"
#include "kernels/linalg/flush_denormals.hpp"
#include "kernels/linalg/parallel.hpp"

namespace twinmap::gp {

using Eigen::Index;
using linalg::padded;

namespace {

constexpr double kLogTwoPi = 1.8378770664093454836;
constexpr double kFirstJitter = 1e-14;  // relative to the diagonal: below rounding, cannot change a result
constexpr double kLastJitter = 1e-6;    // beyond it the model itself would be another one

linalg::View factor_view(LikelihoodWorkspace& workspace) {
  return {workspace.factor.data(), workspace.factor.cols(), workspace.factor.cols(), workspace.factor.rows()};
}

linalg::View weights_view(LikelihoodWorkspace& workspace) {
  return {workspace.weights.data(), workspace.weights.cols(), workspace.weights.cols(),
          workspace.weights.rows()};
}

void add_linear_term(const TrainingSet& set, double linear_stddev, linalg::View factor, Index j) {
  AlignedColumn column = lower_column(factor, j);
  column += linear_stddev * linear_stddev * lower_column(set.gram(), j);
}

// Column j of K in place of q's, of dK's weights, and of the shape's derivative.
void calc_covariance_column(const TrainingSet& set, const Hyperparameters& hyperparameters, double diagonal,
                            Index j, int thread, LikelihoodWorkspace& workspace) {
  const ModelStructure& structure = set.structure();
  const double variance = hyperparameters.signal_stddev * hyperparameters.signal_stddev;
  const linalg::View factor = factor_view(workspace);
  AlignedColumn value = lower_column(factor, j);
  AlignedColumn weight = lower_column(weights_view(workspace), j);
  AlignedColumn q(workspace.squared_distance.col(thread).data(), value.size());
  const ConstAlignedColumn q_read(q.data(), q.size());
  q = value;
  evaluate_radial(structure.covariance, hyperparameters.shape, q_read, value, weight);
  value *= variance;
  weight *= variance;
  if (has_shape(structure.covariance)) {
    AlignedColumn derivative(workspace.shape_derivative.col(j).data() + first_of_line(j), value.size());
    evaluate_shape_derivative(hyperparameters.shape, q_read, derivative);
    derivative *= variance;
  }
  if (structure.linear_term) add_linear_term(set, hyperparameters.linear_stddev, factor, j);
  factor(j, j) += diagonal;
}

void calc_covariance(const TrainingSet& set, const Hyperparameters& hyperparameters, double diagonal,
                     LikelihoodWorkspace& workspace) {
  set.distances().calc(hyperparameters.length_scales, factor_view(workspace), workspace.distances,
                       workspace.scratch);
  linalg::parallel_for(workspace.scratch.threads(), set.size(), 16, [&](Index j, int thread) {
    calc_covariance_column(set, hyperparameters, diagonal, j, thread, workspace);
  });
}

double mean_diagonal(const TrainingSet& set, const Hyperparameters& hyperparameters) {
  double variance = hyperparameters.signal_stddev * hyperparameters.signal_stddev;
  if (set.structure().linear_term) {
    double trace = 0.0;
    for (Index i = 0; i < set.size(); ++i) trace += set.gram()(i, i);
    variance += hyperparameters.linear_stddev * hyperparameters.linear_stddev * trace / double(set.size());
  }
  return variance + hyperparameters.noise_stddev * hyperparameters.noise_stddev;
}

// Factorises K + jitter I with the smallest jitter of the ladder that works.
bool factorize(const TrainingSet& set, const Hyperparameters& hyperparameters, LikelihoodWorkspace& workspace,
               double& jitter) {
  const double noise_variance = hyperparameters.noise_stddev * hyperparameters.noise_stddev;
  const double scale = mean_diagonal(set, hyperparameters);
  if (!std::isfinite(scale)) return false;
  for (double relative = 0.0; relative <= kLastJitter * 1.01;
       relative = relative == 0.0 ? kFirstJitter : 10.0 * relative) {
    jitter = relative * scale;
    calc_covariance(set, hyperparameters, noise_variance + jitter, workspace);
    if (linalg::factorize_cholesky(factor_view(workspace), workspace.scratch)) return true;
  }
  return false;
}

// Generalised least squares for the mean: V = L^-1 H', A = V'V = R R', b = A^-1 V'z; returns log|R|. On entry
// z = L^-1 y, on return z = L^-1 (y - H'b). False (NaN) if the basis is rank deficient.
double fit_mean(const TrainingSet& set, LikelihoodWorkspace& workspace, Eigen::Ref<Eigen::VectorXd> z) {
  const Index p = set.mean_basis().cols();
  if (p == 0) return 0.0;
  workspace.whitened_basis = set.mean_basis();
  const linalg::View basis = linalg::view_of(workspace.whitened_basis);
  for (Index k = 0; k < p; ++k) linalg::solve_lower(factor_view(workspace), basis.col(k));
  const linalg::View normal = linalg::view_of(workspace.basis_factor);
  linalg::gemm(1.0, basis.transposed(), basis, 0.0, normal, workspace.scratch.gemm());
  if (!linalg::factorize_cholesky(normal, workspace.scratch)) return std::nan("");
  double log_determinant = 0.0;
  for (Index k = 0; k < p; ++k) {
    log_determinant += std::log(normal(k, k));
    workspace.mean_coefficients(k) = workspace.whitened_basis.col(k).dot(z);
  }
  linalg::solve_lower(normal, workspace.mean_coefficients.data());
  linalg::solve_lower_transposed(normal, workspace.mean_coefficients.data());
  for (Index k = 0; k < p; ++k) z -= workspace.mean_coefficients(k) * workspace.whitened_basis.col(k);
  return log_determinant;
}

// U = L^-T V R^-T, so that U U' = K^-1 H' A^-1 H K^-1; into the columns behind alpha.
void calc_mean_correction(LikelihoodWorkspace& workspace) {
  const Index p = workspace.whitened_basis.cols();
  if (p == 0) return;
  workspace.corrections.rightCols(p) = workspace.whitened_basis;
  const linalg::View u = linalg::view_of(workspace.corrections).block(0, 1, workspace.corrections.rows(), p);
  linalg::solve_transposed_from_right(linalg::view_of(workspace.basis_factor), u, workspace.scratch);
  for (Index k = 0; k < p; ++k) linalg::solve_lower_transposed(factor_view(workspace), u.col(k));
}

// W's lower triangle replaces L; returns tr(W).
double calc_inverse_minus_corrections(LikelihoodWorkspace& workspace) {
  const linalg::View factor = factor_view(workspace);
  const linalg::ConstView corrections = linalg::view_of(workspace.corrections);
  linalg::invert_lower(factor, workspace.scratch);
  linalg::multiply_transposed_by_self(factor, workspace.scratch);
  workspace.scratch.multiply(-1.0, corrections, corrections.transposed(), 1.0, factor, linalg::Part::kLower);
  double trace = 0.0;
  for (Index j = 0; j < factor.cols; ++j) trace += factor(j, j);
  return trace;
}

// sum over i > j of W_ij M_ij plus half the diagonal's: 1/2 tr(W M) for symmetric M.
double half_trace_with(LikelihoodWorkspace& workspace, const Eigen::MatrixXd& matrix) {
  const linalg::View factor = factor_view(workspace);
  double sum = 0.0;
  for (Index j = 0; j < factor.cols; ++j) {
    const Index below = factor.cols - j - 1;
    const Eigen::Map<const Eigen::ArrayXd> w(factor.col(j) + j + 1, below);
    sum += (w * matrix.col(j).segment(j + 1, below).array()).sum() + 0.5 * factor(j, j) * matrix(j, j);
  }
  return sum;
}

// T = W .* weights, strictly lower.
void multiply_weights(LikelihoodWorkspace& workspace) {
  const linalg::View factor = factor_view(workspace);
  const linalg::View weights = weights_view(workspace);
  linalg::parallel_for(workspace.scratch.threads(), factor.cols, 16, [&](Index j, int) {
    lower_column(weights, j) *= lower_column(factor, j);
    clear_outside_strict_lower(weights, j);
  });
}

void calc_gradient(const TrainingSet& set, const Eigen::VectorXd& target,
                   const Hyperparameters& hyperparameters, double jitter, LikelihoodWorkspace& workspace,
                   Eigen::VectorXd& gradient) {
  const HyperparameterLayout layout(set.structure());
  const double noise_variance = hyperparameters.noise_stddev * hyperparameters.noise_stddev;
  const double free_samples = static_cast<double>(set.size() - set.mean_basis().cols());
  calc_mean_correction(workspace);
  const double trace = calc_inverse_minus_corrections(workspace);
  const double trace_with_total = free_samples - workspace.corrections.col(0).dot(target);
  double trace_with_linear = 0.0;
  if (layout.linear >= 0) {
    trace_with_linear = 2.0 * hyperparameters.linear_stddev * hyperparameters.linear_stddev *
                        half_trace_with(workspace, set.gram());
    gradient(layout.linear) = trace_with_linear;
  }
  gradient(layout.noise) = noise_variance * trace;
  gradient(layout.signal) = trace_with_total - (noise_variance + jitter) * trace - trace_with_linear;
  if (layout.shape >= 0) gradient(layout.shape) = half_trace_with(workspace, workspace.shape_derivative);
  multiply_weights(workspace);
  set.distances().contract(hyperparameters.length_scales, weights_view(workspace), workspace.distances,
                           workspace.scratch, workspace.group_sums);
  gradient.head(layout.signal) = workspace.group_sums;
}

}  // namespace

LikelihoodWorkspace::LikelihoodWorkspace(const TrainingSet& set, int threads)
    : factor(Eigen::MatrixXd::Zero(padded(set.size()), set.size())),
      weights(Eigen::MatrixXd::Zero(padded(set.size()), set.size())),
      corrections(set.size(), 1 + set.mean_basis().cols()),
      whitened_basis(set.size(), set.mean_basis().cols()),
      basis_factor(set.mean_basis().cols(), set.mean_basis().cols()),
      mean_coefficients(set.mean_basis().cols()),
      squared_distance(padded(set.size()), threads),
      group_sums(set.distances().group_count()),
      distances(set.distances()),
      scratch(std::max(set.size(), set.mean_basis().cols()), threads) {
  if (has_shape(set.structure().covariance)) shape_derivative.setZero(padded(set.size()), set.size());
}

LikelihoodEvaluation evaluate_likelihood(const TrainingSet& set, const Eigen::VectorXd& target,
                                         const Hyperparameters& hyperparameters,
                                         LikelihoodWorkspace& workspace) {
  const linalg::FlushDenormals flush;
  LikelihoodEvaluation evaluation;
  evaluation.nlml = std::numeric_limits<double>::infinity();
  if (!factorize(set, hyperparameters, workspace, evaluation.jitter)) return evaluation;
  const linalg::View factor = factor_view(workspace);
  auto z = workspace.corrections.col(0);
  z = target;
  linalg::solve_lower(factor, z.data());
  double nlml = fit_mean(set, workspace, z) + 0.5 * z.squaredNorm();
  for (Index j = 0; j < set.size(); ++j) nlml += std::log(factor(j, j));
  nlml += 0.5 * kLogTwoPi * static_cast<double>(set.size() - set.mean_basis().cols());
  if (!std::isfinite(nlml)) return evaluation;
  linalg::solve_lower_transposed(factor, z.data());
  evaluation.ok = true;
  evaluation.nlml = nlml;
  return evaluation;
}

LikelihoodEvaluation evaluate_likelihood_gradient(const TrainingSet& set, const Eigen::VectorXd& target,
                                                  const Hyperparameters& hyperparameters,
                                                  LikelihoodWorkspace& workspace, Eigen::VectorXd& gradient) {
  const linalg::FlushDenormals flush;
  const LikelihoodEvaluation evaluation = evaluate_likelihood(set, target, hyperparameters, workspace);
  gradient.setZero();
  if (!evaluation.ok) return evaluation;
  calc_gradient(set, target, hyperparameters, evaluation.jitter, workspace, gradient);
  return evaluation;
}

}  // namespace twinmap::gp
