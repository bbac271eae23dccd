#include "kernels/gp/marginal_likelihood.hpp"

#include <cmath>
#include <limits>

#include "kernels/gp/covariance/columns.hpp"
#include "kernels/gp/covariance/radial.hpp"
#include "kernels/linalg/flush_denormals.hpp"
#include "kernels/linalg/parallel.hpp"

namespace twinmap::gp {

using Eigen::Index;
using linalg::padded;

namespace {

constexpr double kFirstJitter = 1e-14;  // relative to the diagonal: below rounding, cannot change a result
constexpr double kLastJitter = 1e-6;    // beyond it the model itself would be another one
// Columns of a triangle, unequally long, that a thread takes at a time: enough to pay for the taking.
constexpr Index kColumnChunk = 16;

linalg::View factorView(LikelihoodWorkspace& workspace) {
  return {workspace.factor.data(), workspace.factor.cols(), workspace.factor.cols(), workspace.factor.rows()};
}

linalg::View weightsView(LikelihoodWorkspace& workspace) {
  return {workspace.weights.data(), workspace.weights.cols(), workspace.weights.cols(),
          workspace.weights.rows()};
}

void addLinearColumn(const TrainingSet& set, double linear_stddev, linalg::View factor, Index j) {
  AlignedColumn column = lowerColumn(factor, j);
  column += linear_stddev * linear_stddev * lowerColumn(set.gram(), j);
}

// Column j of K in place of q's, of dK's weights, and of the shape's derivative.
void calcCovarianceColumn(const TrainingSet& set, const Hyperparameters& hyperparameters, double diagonal,
                          Index j, int thread, LikelihoodWorkspace& workspace) {
  const ModelStructure& structure = set.getStructure();
  const double variance = hyperparameters.signal_stddev * hyperparameters.signal_stddev;
  const linalg::View factor = factorView(workspace);
  AlignedColumn value = lowerColumn(factor, j);
  AlignedColumn weight = lowerColumn(weightsView(workspace), j);
  AlignedColumn q(workspace.squared_distance.col(thread).data(), value.size());
  const ConstAlignedColumn q_read(q.data(), q.size());
  q = value;
  evaluateRadial(structure.covariance, hyperparameters.shape, q_read, value, weight);
  value *= variance;
  weight *= variance;
  if (hasShape(structure.covariance)) {
    AlignedColumn derivative(workspace.shape_derivative.col(j).data() + firstOfLine(j), value.size());
    evaluateShapeDerivative(hyperparameters.shape, q_read, derivative);
    derivative *= variance;
  }
  if (structure.linear_term) {
    addLinearColumn(set, hyperparameters.linear_stddev, factor, j);
  }
  factor(j, j) += diagonal;
}

void calcCovariance(const TrainingSet& set, const Hyperparameters& hyperparameters, double diagonal,
                    LikelihoodWorkspace& workspace) {
  set.distances().calc(hyperparameters.length_scales, factorView(workspace), workspace.distances,
                       workspace.scratch);
  linalg::parallelFor(workspace.scratch.threads(), set.size(), kColumnChunk, [&](Index j, int thread) {
    calcCovarianceColumn(set, hyperparameters, diagonal, j, thread, workspace);
  });
}

double meanDiagonal(const TrainingSet& set, const Hyperparameters& hyperparameters) {
  double variance = hyperparameters.signal_stddev * hyperparameters.signal_stddev;
  if (set.getStructure().linear_term) {
    double trace = 0.0;
    for (Index i = 0; i < set.size(); ++i) {
      trace += set.gram()(i, i);
    }
    variance += hyperparameters.linear_stddev * hyperparameters.linear_stddev * trace / double(set.size());
  }
  return variance + hyperparameters.noise_stddev * hyperparameters.noise_stddev;
}

// Factorises K + jitter I with the smallest jitter of the ladder that works.
bool factorize(const TrainingSet& set, const Hyperparameters& hyperparameters, LikelihoodWorkspace& workspace,
               double& jitter) {
  const double noise_variance = hyperparameters.noise_stddev * hyperparameters.noise_stddev;
  const double scale = meanDiagonal(set, hyperparameters);
  if (!std::isfinite(scale)) {
    return false;
  }
  constexpr double kRounding = 1.01;  // of ten multiplications
  for (double relative = 0.0; relative <= kLastJitter * kRounding;
       relative = relative == 0.0 ? kFirstJitter : 10.0 * relative) {
    jitter = relative * scale;
    calcCovariance(set, hyperparameters, noise_variance + jitter, workspace);
    if (linalg::factorizeCholesky(factorView(workspace), workspace.scratch)) {
      return true;
    }
  }
  return false;
}

// Generalised least squares for the mean: V = L^-1 H', A = V'V = R R', b = A^-1 V'z; returns log|R|. On entry
// z = L^-1 y, on return z = L^-1 (y - H'b). False (NaN) if the basis is rank deficient.
double fitMean(const TrainingSet& set, LikelihoodWorkspace& workspace, Eigen::Ref<Eigen::VectorXd> z) {
  const Index p = set.meanBasis().cols();
  if (p == 0) {
    return 0.0;
  }
  workspace.whitened_basis = set.meanBasis();
  const linalg::View basis = linalg::viewOf(workspace.whitened_basis);
  for (Index k = 0; k < p; ++k) {
    linalg::solveLower(factorView(workspace), basis.col(k));
  }
  const linalg::View normal = linalg::viewOf(workspace.basis_factor);
  linalg::gemm(1.0, basis.transposed(), basis, 0.0, normal, workspace.scratch.gemm());
  if (!linalg::factorizeCholesky(normal, workspace.scratch)) {
    return std::nan("");
  }
  double log_determinant = 0.0;
  for (Index k = 0; k < p; ++k) {
    log_determinant += std::log(normal(k, k));
    workspace.mean_coefficients(k) = workspace.whitened_basis.col(k).dot(z);
  }
  linalg::solveLower(normal, workspace.mean_coefficients.data());
  linalg::solveLowerTransposed(normal, workspace.mean_coefficients.data());
  for (Index k = 0; k < p; ++k) {
    z -= workspace.mean_coefficients(k) * workspace.whitened_basis.col(k);
  }
  return log_determinant;
}

// U = L^-T V R^-T, so that U U' = K^-1 H' A^-1 H K^-1; into the columns behind alpha.
void calcMeanCorrection(LikelihoodWorkspace& workspace) {
  const Index p = workspace.whitened_basis.cols();
  if (p == 0) {
    return;
  }
  workspace.corrections.rightCols(p) = workspace.whitened_basis;
  const linalg::View u = linalg::viewOf(workspace.corrections).block(0, 1, workspace.corrections.rows(), p);
  linalg::solveTransposedFromRight(linalg::viewOf(workspace.basis_factor), u, workspace.scratch);
  for (Index k = 0; k < p; ++k) {
    linalg::solveLowerTransposed(factorView(workspace), u.col(k));
  }
}

// W's lower triangle replaces L; returns tr(W).
double calcInverseMinusCorrections(LikelihoodWorkspace& workspace) {
  const linalg::View factor = factorView(workspace);
  const linalg::ConstView corrections = linalg::viewOf(workspace.corrections);
  linalg::invertLower(factor, workspace.scratch);
  linalg::multiplyTransposedBySelf(factor, workspace.scratch);
  workspace.scratch.multiply(-1.0, corrections, corrections.transposed(), 1.0, factor, linalg::Part::kLower);
  double trace = 0.0;
  for (Index j = 0; j < factor.cols; ++j) {
    trace += factor(j, j);
  }
  return trace;
}

// sum over i > j of W_ij M_ij plus half the diagonal's: 1/2 tr(W M) for symmetric M.
double halfTraceWith(LikelihoodWorkspace& workspace, const Eigen::MatrixXd& matrix) {
  const linalg::View factor = factorView(workspace);
  double sum = 0.0;
  for (Index j = 0; j < factor.cols; ++j) {
    const Index below = factor.cols - j - 1;
    const Eigen::Map<const Eigen::ArrayXd> w(factor.col(j) + j + 1, below);
    sum += (w * matrix.col(j).segment(j + 1, below).array()).sum() + 0.5 * factor(j, j) * matrix(j, j);
  }
  return sum;
}

// T = W .* weights, strictly lower.
void multiplyWeights(LikelihoodWorkspace& workspace) {
  const linalg::View factor = factorView(workspace);
  const linalg::View weights = weightsView(workspace);
  linalg::parallelFor(workspace.scratch.threads(), factor.cols, kColumnChunk, [&](Index j, int) {
    lowerColumn(weights, j) *= lowerColumn(factor, j);
    clearOutsideStrictLower(weights, j);
  });
}

void calcGradient(const TrainingSet& set, const Eigen::VectorXd& target,
                  const Hyperparameters& hyperparameters, double jitter, LikelihoodWorkspace& workspace,
                  Eigen::VectorXd& gradient) {
  const HyperparameterLayout layout(set.getStructure());
  const double noise_variance = hyperparameters.noise_stddev * hyperparameters.noise_stddev;
  const double free_samples = static_cast<double>(set.size() - set.meanBasis().cols());
  calcMeanCorrection(workspace);
  const double trace = calcInverseMinusCorrections(workspace);
  const double trace_with_total = free_samples - workspace.corrections.col(0).dot(target);
  double trace_with_linear = 0.0;
  if (layout.linear >= 0) {
    trace_with_linear = 2.0 * hyperparameters.linear_stddev * hyperparameters.linear_stddev *
                        halfTraceWith(workspace, set.gram());
    gradient(layout.linear) = trace_with_linear;
  }
  gradient(layout.noise) = noise_variance * trace;
  gradient(layout.signal) = trace_with_total - (noise_variance + jitter) * trace - trace_with_linear;
  if (layout.shape >= 0) {
    gradient(layout.shape) = halfTraceWith(workspace, workspace.shape_derivative);
  }
  multiplyWeights(workspace);
  set.distances().contract(hyperparameters.length_scales, weightsView(workspace), workspace.distances,
                           workspace.scratch, workspace.group_sums);
  gradient.head(layout.signal) = workspace.group_sums;
}

}  // namespace

int getTeamSize(const TrainingSet& set, int threads) {
  constexpr Eigen::Index kTeamSamples = 1500;  // 2 n^2 doubles: 36 MB, beyond which one workspace is enough
  return set.size() > kTeamSamples ? threads : 1;
}

LikelihoodWorkspace::LikelihoodWorkspace(const TrainingSet& set, int threads)
    : factor(Eigen::MatrixXd::Zero(padded(set.size()), set.size())),
      weights(Eigen::MatrixXd::Zero(padded(set.size()), set.size())),
      corrections(set.size(), 1 + set.meanBasis().cols()),
      whitened_basis(set.size(), set.meanBasis().cols()),
      basis_factor(set.meanBasis().cols(), set.meanBasis().cols()),
      mean_coefficients(set.meanBasis().cols()),
      squared_distance(padded(set.size()), threads),
      group_sums(set.distances().getGroupCount()),
      distances(set.distances()),
      scratch(std::max(set.size(), set.meanBasis().cols()), threads) {
  if (hasShape(set.getStructure().covariance)) {
    shape_derivative.setZero(padded(set.size()), set.size());
  }
}

LikelihoodEvaluation evaluateLikelihood(const TrainingSet& set, const Eigen::VectorXd& target,
                                        const Hyperparameters& hyperparameters,
                                        LikelihoodWorkspace& workspace) {
  const linalg::FlushDenormals flush;
  LikelihoodEvaluation evaluation;
  evaluation.nlml = std::numeric_limits<double>::infinity();
  if (!factorize(set, hyperparameters, workspace, evaluation.jitter)) {
    return evaluation;
  }
  const linalg::View factor = factorView(workspace);
  auto z = workspace.corrections.col(0);
  z = target;
  linalg::solveLower(factor, z.data());
  double nlml = fitMean(set, workspace, z) + 0.5 * z.squaredNorm();
  for (Index j = 0; j < set.size(); ++j) {
    nlml += std::log(factor(j, j));
  }
  nlml += 0.5 * kLogTwoPi * static_cast<double>(set.size() - set.meanBasis().cols());
  if (!std::isfinite(nlml)) {
    return evaluation;
  }
  linalg::solveLowerTransposed(factor, z.data());
  evaluation.ok = true;
  evaluation.nlml = nlml;
  return evaluation;
}

LikelihoodEvaluation evaluateLikelihoodGradient(const TrainingSet& set, const Eigen::VectorXd& target,
                                                const Hyperparameters& hyperparameters,
                                                LikelihoodWorkspace& workspace, Eigen::VectorXd& gradient) {
  const linalg::FlushDenormals flush;
  const LikelihoodEvaluation evaluation = evaluateLikelihood(set, target, hyperparameters, workspace);
  gradient.setZero();
  if (!evaluation.ok) {
    return evaluation;
  }
  calcGradient(set, target, hyperparameters, evaluation.jitter, workspace, gradient);
  return evaluation;
}

}  // namespace twinmap::gp
