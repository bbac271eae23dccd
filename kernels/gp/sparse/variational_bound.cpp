#include "kernels/gp/sparse/variational_bound.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>

#include "kernels/gp/cross_covariance.hpp"
#include "kernels/gp/training_set.hpp"
#include "kernels/linalg/flush_denormals.hpp"

namespace twinmap::gp {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using linalg::viewOf;

namespace {

constexpr Index kSampleBlock = 512;  // samples at a time: deep products, and memory 512 m instead of n m
constexpr double kFirstInducingJitter = 1e-10;  // relative to s_f^2; K_uu has no noise to keep it definite
constexpr double kLastInducingJitter = 1e-5;    // beyond it the model itself would be another one

MatrixXd lowerPart(const MatrixXd& matrix) {
  return matrix.triangularView<Eigen::Lower>();
}

MatrixXd symmetricFromLower(const MatrixXd& matrix) {
  return matrix.selfadjointView<Eigen::Lower>();
}

MatrixXd multiply(linalg::ConstView a, linalg::ConstView b, linalg::GemmScratch& scratch) {
  MatrixXd product(a.rows, b.cols);
  linalg::gemm(1.0, a, b, 0.0, viewOf(product), scratch);
  return product;
}

// columns = L^-T columns
void solveColumnsTransposed(const MatrixXd& lower, Eigen::Ref<MatrixXd> columns) {
  for (Index k = 0; k < columns.cols(); ++k) {
    linalg::solveLowerTransposed(viewOf(lower), columns.col(k).data());
  }
}

// sums(g) += sum over i, j and the features of group g of T_ij (x_fi - z_fj)^2, x and z in length scales.
void addContraction(const MatrixXd& t, const MatrixXd& x, const MatrixXd& z, const std::vector<int>& groups,
                    linalg::GemmScratch& scratch, VectorXd& sums) {
  const VectorXd row_sums = t.rowwise().sum();
  const VectorXd column_sums = t.colwise().sum().transpose();
  const MatrixXd product = multiply(viewOf(x), viewOf(t), scratch);
  for (Index f = 0; f < x.rows(); ++f) {
    sums(groups.empty() ? 0 : groups[f]) += row_sums.dot(x.row(f).cwiseAbs2().transpose()) +
                                            column_sums.dot(z.row(f).cwiseAbs2().transpose()) -
                                            2.0 * product.row(f).dot(z.row(f));
  }
}

}  // namespace

// Sums over the samples, with right-hand sides R = [y, H'].
struct VariationalBound::Sums {
  MatrixXd aa;  // A A', lower
  MatrixXd ar;  // A R
  MatrixXd rr;  // R'R
  MatrixXd v;   // L_B^-1 A R / s_n, filled by solve
};

VariationalBound::VariationalBound(const MatrixXd& inputs, const VectorXd& target, const MatrixXd& inducing,
                                   const ModelStructure& structure)
    : inputs_(inputs),
      target_(target),
      inducing_(inducing),
      structure_(structure),
      center_(calcCenter(inputs)) {
  if (structure.linear_term) {
    throw std::invalid_argument("sparse processes have no linear covariance term; use a linear mean instead");
  }
}

MatrixXd VariationalBound::scaledBlock(const Hyperparameters& hyperparameters, Index first) const {
  const Index count = std::min(kSampleBlock, inputs_.cols() - first);
  const VectorXd scales = lengthScaleOfFeatures(structure_, hyperparameters, inputs_.rows());
  return scales.cwiseInverse().asDiagonal() * (inputs_.middleCols(first, count).colwise() - center_);
}

MatrixXd VariationalBound::scaledInducing(const Hyperparameters& hyperparameters) const {
  const VectorXd scales = lengthScaleOfFeatures(structure_, hyperparameters, inputs_.rows());
  return scales.cwiseInverse().asDiagonal() * (inducing_.colwise() - center_);
}

MatrixXd VariationalBound::rightHandSides(Index first) const {
  const Index count = std::min(kSampleBlock, inputs_.cols() - first);
  const MatrixXd centered = inputs_.middleCols(first, count).colwise() - center_;
  const MatrixXd basis = calcMeanBasis(structure_.mean, centered);
  MatrixXd right(count, 1 + basis.cols());
  right << target_.segment(first, count), basis;
  return right;
}

VariationalBound::Sums VariationalBound::accumulate(const Hyperparameters& hyperparameters,
                                                    const MatrixXd& inducing_factor) const {
  const Index m = inducing_.cols();
  const Index columns = 1 + getMeanCoefficientCount(structure_, inputs_.rows());
  Sums sums{MatrixXd::Zero(m, m), MatrixXd::Zero(m, columns), MatrixXd::Zero(columns, columns), {}};
  linalg::TriangularScratch scratch(std::max(m, kSampleBlock));
  const MatrixXd z = scaledInducing(hyperparameters);
  for (Index first = 0; first < inputs_.cols(); first += kSampleBlock) {
    const MatrixXd x = scaledBlock(hyperparameters, first);
    MatrixXd a = calcCrossCovariance(structure_, hyperparameters, x, z);  // K_fu, then A' of the block
    linalg::solveTransposedFromRight(viewOf(inducing_factor), viewOf(a), scratch);
    const MatrixXd right = rightHandSides(first);
    const linalg::ConstView a_view = viewOf(a), right_view = viewOf(right);
    linalg::gemm(1.0, a_view.transposed(), a_view, 1.0, viewOf(sums.aa), scratch.gemm(),
                 linalg::Part::kLower);
    linalg::gemm(1.0, a_view.transposed(), right_view, 1.0, viewOf(sums.ar), scratch.gemm());
    linalg::gemm(1.0, right_view.transposed(), right_view, 1.0, viewOf(sums.rr), scratch.gemm());
  }
  return sums;
}

bool VariationalBound::factorizeInducing(const Hyperparameters& hyperparameters,
                                         VariationalPosterior& posterior) const {
  const double signal_variance = hyperparameters.signal_stddev * hyperparameters.signal_stddev;
  const MatrixXd z = scaledInducing(hyperparameters);
  const MatrixXd prior = calcCrossCovariance(structure_, hyperparameters, z, z);
  linalg::TriangularScratch scratch(z.cols());
  for (double relative = kFirstInducingJitter; relative < 2.0 * kLastInducingJitter; relative *= 10.0) {
    posterior.jitter = relative * signal_variance;
    posterior.inducing_factor = prior;
    posterior.inducing_factor.diagonal().array() += posterior.jitter;
    if (!linalg::factorizeCholesky(viewOf(posterior.inducing_factor), scratch)) {
      continue;
    }
    posterior.inducing_factor = lowerPart(posterior.inducing_factor);
    return true;
  }
  return false;
}

bool VariationalBound::factorizeCorrection(double noise_stddev, Sums& sums,
                                           VariationalPosterior& posterior) const {
  linalg::TriangularScratch scratch(inducing_.cols());
  posterior.correction_factor = sums.aa / (noise_stddev * noise_stddev);
  posterior.correction_factor.diagonal().array() += 1.0;
  if (!linalg::factorizeCholesky(viewOf(posterior.correction_factor), scratch)) {
    return false;
  }
  posterior.correction_factor = lowerPart(posterior.correction_factor);
  sums.v = sums.ar / noise_stddev;
  for (Index k = 0; k < sums.v.cols(); ++k) {
    linalg::solveLower(viewOf(posterior.correction_factor), sums.v.col(k).data());
  }
  return true;
}

// Generalised least squares on `products`, whose element (u, v) is u'P^-1 v of the columns of R; b and R go
// into the posterior. Returns the quadratic term; NaN if the basis is rank deficient.
double VariationalBound::fitMean(const MatrixXd& products, VariationalPosterior& posterior) {
  const Index p = products.cols() - 1;
  posterior.basis_factor = products.bottomRightCorner(p, p);
  posterior.mean_coefficients = products.bottomLeftCorner(p, 1);
  if (p == 0) {
    return products(0, 0);
  }
  linalg::TriangularScratch scratch(p);
  if (!linalg::factorizeCholesky(viewOf(posterior.basis_factor), scratch)) {
    return std::nan("");
  }
  posterior.basis_factor = lowerPart(posterior.basis_factor);
  linalg::solveLower(viewOf(posterior.basis_factor), posterior.mean_coefficients.data());
  const double explained = posterior.mean_coefficients.squaredNorm();
  linalg::solveLowerTransposed(viewOf(posterior.basis_factor), posterior.mean_coefficients.data());
  return products(0, 0) - explained;
}

// Leaves L_B^-T V, not yet L^-T of it, in the weights: evaluate needs them so.
bool VariationalBound::solve(const Hyperparameters& hyperparameters, VariationalPosterior& posterior,
                             Sums& sums) const {
  const double noise_stddev = hyperparameters.noise_stddev;
  const double noise_variance = noise_stddev * noise_stddev;
  if (!factorizeInducing(hyperparameters, posterior)) {
    return false;
  }
  sums = accumulate(hyperparameters, posterior.inducing_factor);
  if (!factorizeCorrection(noise_stddev, sums, posterior)) {
    return false;
  }
  linalg::GemmScratch scratch;
  const MatrixXd explained = multiply(viewOf(sums.v).transposed(), viewOf(sums.v), scratch);
  const double quadratic = fitMean((sums.rr - explained) / noise_variance, posterior);
  const auto n = static_cast<double>(inputs_.cols());
  const auto p = static_cast<double>(posterior.mean_coefficients.size());
  posterior.bound = 0.5 * quadratic + n * std::log(noise_stddev) + 0.5 * (n - p) * kLogTwoPi +
                    posterior.correction_factor.diagonal().array().log().sum() +
                    posterior.basis_factor.diagonal().array().log().sum() +
                    0.5 * missedVariance(hyperparameters, sums) / noise_variance;
  posterior.whitened_basis = sums.v.rightCols(posterior.mean_coefficients.size());
  posterior.weights = (sums.v.col(0) - posterior.whitened_basis * posterior.mean_coefficients) / noise_stddev;
  solveColumnsTransposed(posterior.correction_factor, posterior.weights);
  return std::isfinite(posterior.bound);
}

// n s_f^2 - tr Q: what the inducing inputs leave undetermined.
double VariationalBound::missedVariance(const Hyperparameters& hyperparameters, const Sums& sums) const {
  const double signal_variance = hyperparameters.signal_stddev * hyperparameters.signal_stddev;
  return std::max(0.0, static_cast<double>(inputs_.cols()) * signal_variance - sums.aa.trace());
}

bool VariationalBound::calcPosterior(const Hyperparameters& hyperparameters,
                                     VariationalPosterior& posterior) const {
  const linalg::FlushDenormals flush;
  Sums sums;
  if (!solve(hyperparameters, posterior, sums)) {
    return false;
  }
  solveColumnsTransposed(posterior.inducing_factor, posterior.weights);
  return true;
}

// With M = P^-1 - C C' - I / s_n^2, C = [alpha, U] and E = -(I - B^-1) / s_n^2:
//   dF/dK_uf = L^-T (E A - (A C) C'),   dF/dK_uu = 1/2 L^-T (B - 2 I + B^-1 + (A C)(A C)') L^-1.
struct VariationalBound::Gradients {
  Gradients(const VariationalPosterior& posterior, double noise_stddev, linalg::TriangularScratch& scratch);

  MatrixXd solutions;       // B^-1 A [y - H'b, H'] / s_n^2
  MatrixXd ac;              // A C
  MatrixXd inverse_factor;  // L^-1
  MatrixXd inverse_b;       // B^-1
  MatrixXd e;               // E L^-1
  MatrixXd d;               // (A C)' L^-1
  VectorXd group_sums;
  double alpha_times_target = 0.0;
  double squared_corrections = 0.0;  // |C|^2
};

VariationalBound::Gradients::Gradients(const VariationalPosterior& posterior, double noise_stddev,
                                       linalg::TriangularScratch& scratch)
    : solutions(posterior.weights.size(), 1 + posterior.mean_coefficients.size()),
      inverse_factor(posterior.inducing_factor),
      inverse_b(posterior.correction_factor) {
  const Index m = solutions.rows(), p = solutions.cols() - 1;
  solutions << posterior.weights, posterior.whitened_basis / noise_stddev;
  solveColumnsTransposed(posterior.correction_factor, solutions.rightCols(p));
  ac = solutions;
  if (p > 0) {
    linalg::solveTransposedFromRight(viewOf(posterior.basis_factor), viewOf(ac).block(0, 1, m, p), scratch);
  }
  linalg::invertLower(viewOf(inverse_factor), scratch);
  linalg::invertLower(viewOf(inverse_b), scratch);
  linalg::multiplyTransposedBySelf(viewOf(inverse_b), scratch);
  inverse_b = symmetricFromLower(inverse_b);
  const MatrixXd shrinkage = (inverse_b - MatrixXd::Identity(m, m)) / (noise_stddev * noise_stddev);
  e = multiply(viewOf(shrinkage), viewOf(inverse_factor), scratch.gemm());
  d = multiply(viewOf(ac).transposed(), viewOf(inverse_factor), scratch.gemm());
}

void VariationalBound::addSamples(const Hyperparameters& hyperparameters,
                                  const VariationalPosterior& posterior, const MatrixXd& z, Index first,
                                  linalg::TriangularScratch& scratch, Gradients& gradients) const {
  const double noise_variance = hyperparameters.noise_stddev * hyperparameters.noise_stddev;
  const Index p = posterior.mean_coefficients.size();
  const MatrixXd x = scaledBlock(hyperparameters, first);
  MatrixXd weights;
  MatrixXd a = calcCrossCovariance(structure_, hyperparameters, x, z, &weights);
  linalg::solveTransposedFromRight(viewOf(posterior.inducing_factor), viewOf(a), scratch);
  const VectorXd target = target_.segment(first, x.cols());
  MatrixXd c = rightHandSides(first);  // becomes C's rows of this block
  c.col(0) -= c.rightCols(p) * posterior.mean_coefficients;
  linalg::gemm(-1.0, viewOf(a), viewOf(gradients.solutions), 1.0, viewOf(c), scratch.gemm());
  c /= noise_variance;
  if (p > 0) {
    linalg::solveTransposedFromRight(viewOf(posterior.basis_factor), viewOf(c).block(0, 1, c.rows(), p),
                                     scratch);
  }
  gradients.alpha_times_target += c.col(0).dot(target);
  gradients.squared_corrections += c.squaredNorm();
  MatrixXd t = multiply(viewOf(a), viewOf(gradients.e), scratch.gemm());
  linalg::gemm(-1.0, viewOf(c), viewOf(gradients.d), 1.0, viewOf(t), scratch.gemm());
  t.array() *= weights.array();
  addContraction(t, x, z, structure_.length_scale_groups, scratch.gemm(), gradients.group_sums);
}

void VariationalBound::addInducing(const Hyperparameters& hyperparameters, const MatrixXd& aa,
                                   const MatrixXd& z, linalg::GemmScratch& scratch,
                                   Gradients& gradients) const {
  const double noise_variance = hyperparameters.noise_stddev * hyperparameters.noise_stddev;
  const MatrixXd b_less_two = aa / noise_variance - MatrixXd::Identity(aa.rows(), aa.cols());
  const MatrixXd inner = symmetricFromLower(b_less_two) + gradients.inverse_b +
                         multiply(viewOf(gradients.ac), viewOf(gradients.ac).transposed(), scratch);
  const MatrixXd half = multiply(viewOf(inner), viewOf(gradients.inverse_factor), scratch);
  MatrixXd t = 0.5 * multiply(viewOf(gradients.inverse_factor).transposed(), viewOf(half), scratch);
  MatrixXd weights;
  (void)calcCrossCovariance(structure_, hyperparameters, z, z, &weights);
  t.array() *= weights.array();
  addContraction(t, z, z, structure_.length_scale_groups, scratch, gradients.group_sums);
}

LikelihoodEvaluation VariationalBound::evaluate(const Hyperparameters& hyperparameters,
                                                VectorXd& gradient) const {
  const linalg::FlushDenormals flush;
  LikelihoodEvaluation evaluation{false, std::numeric_limits<double>::infinity(), 0.0};
  gradient.setZero();
  VariationalPosterior posterior;
  Sums sums;
  if (!solve(hyperparameters, posterior, sums)) {
    return evaluation;
  }
  evaluation = {true, posterior.bound, posterior.jitter};

  linalg::TriangularScratch scratch(std::max(inducing_.cols(), kSampleBlock));
  Gradients gradients(posterior, hyperparameters.noise_stddev, scratch);
  gradients.group_sums = VectorXd::Zero(getGroupCount(structure_));
  const MatrixXd z = scaledInducing(hyperparameters);
  for (Index first = 0; first < inputs_.cols(); first += kSampleBlock) {
    addSamples(hyperparameters, posterior, z, first, scratch, gradients);
  }
  addInducing(hyperparameters, sums.aa, z, scratch.gemm(), gradients);

  // With tr(W P) = n - p - alpha'y, W = P^-1 - C C'.
  const HyperparameterLayout layout(structure_);
  const double noise_variance = hyperparameters.noise_stddev * hyperparameters.noise_stddev;
  const double missed = missedVariance(hyperparameters, sums) / noise_variance;
  const auto undetermined = static_cast<double>(inputs_.cols() - inducing_.cols());
  const auto free_samples = static_cast<double>(inputs_.cols() - posterior.mean_coefficients.size());
  const double trace =
      undetermined + gradients.inverse_b.trace() - noise_variance * gradients.squared_corrections;
  gradient.head(layout.signal) = gradients.group_sums;
  gradient(layout.noise) = trace - missed;
  gradient(layout.signal) = free_samples - gradients.alpha_times_target - trace + missed;
  return evaluation;
}

}  // namespace twinmap::gp
