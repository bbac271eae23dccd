#include "kernels/surrogate/shared_process.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "kernels/linalg/decompositions.hpp"

namespace twinmap::gp {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

LeftOut calcLeftOut(const MatrixXd& points, const MatrixXd& values, const SharedStructure& structure,
                    const SharedHyperparameters& hyperparameters) {
  LeftOutDensity density(points, values, structure);
  double ignored = 0.0;
  if (!density.evaluate(hyperparameters, ignored)) {
    throw std::runtime_error("a surrogate's covariance is not positive definite");
  }
  return density.getLeftOut();
}

}  // namespace

SharedProcess::SharedProcess(const MatrixXd& points, const MatrixXd& values, SharedStructure structure,
                             SharedHyperparameters hyperparameters)
    : structure_(structure), hyperparameters_(std::move(hyperparameters)) {
  if (values.rows() != points.cols() || hyperparameters_.length_scales.size() != points.rows() ||
      points.cols() <= countTerms(structure.trend, points.rows())) {
    throw std::invalid_argument("SharedProcess: more points than terms, a row of values for each");
  }
  left_out_ = calcLeftOut(points, values, structure_, hyperparameters_);
  MatrixXd covariance, slopes;
  calcSharedCovariance(structure_, hyperparameters_, points, covariance, slopes);
  const linalg::Cholesky factor = linalg::calcCholesky(covariance);
  const MatrixXd terms = calcTerms(structure_.trend, points).transpose();
  solved_terms_ = linalg::solveLower(factor.lower, terms);
  const MatrixXd solved_values = linalg::solveLower(factor.lower, values);
  coefficients_ = linalg::fitLinear(solved_terms_, solved_values).coefficients;
  weights_ = linalg::solveCholesky(factor.lower, values - terms * coefficients_);
  term_factor_ = linalg::calcCholesky(solved_terms_.transpose() * solved_terms_).lower;
  factor_ = linalg::PackedLower(linalg::viewOf(factor.lower));
  scaled_points_ = points.transpose() * hyperparameters_.length_scales.cwiseInverse().asDiagonal();
  updateLeftOutRatio();
}

SharedProcess::SharedProcess(SharedProcessParts parts)
    : structure_(parts.structure),
      hyperparameters_(std::move(parts.hyperparameters)),
      scaled_points_(std::move(parts.scaled_points)),
      weights_(std::move(parts.weights)),
      coefficients_(std::move(parts.coefficients)),
      factor_(linalg::PackedLower::fromTiles(std::move(parts.factor_tiles))),
      solved_terms_(std::move(parts.solved_terms)),
      term_factor_(std::move(parts.term_factor)),
      left_out_ratio_(std::move(parts.left_out_ratio)) {
  left_out_.amplitude = std::move(parts.amplitude);
  const Index n = scaled_points_.rows(), p = scaled_points_.cols(), r = weights_.cols();
  const Index q = countTerms(structure_.trend, p);
  if (hyperparameters_.length_scales.size() != p || weights_.rows() != n || coefficients_.rows() != q ||
      coefficients_.cols() != r || factor_.paddedSize() < n || solved_terms_.rows() != n ||
      solved_terms_.cols() != q || term_factor_.rows() != q || term_factor_.cols() != q ||
      left_out_.amplitude.size() != r || left_out_ratio_.size() != n) {
    throw std::invalid_argument("SharedProcess: parts that do not fit each other");
  }
}

SharedProcessParts SharedProcess::getParts() const {
  return {structure_,         hyperparameters_, scaled_points_, weights_,            coefficients_,
          factor_.getTiles(), solved_terms_,    term_factor_,   left_out_.amplitude, left_out_ratio_};
}

void SharedProcess::updateLeftOutRatio() {
  left_out_ratio_ = (left_out_.residual.array().square().rowwise() / left_out_.amplitude.transpose().array())
                        .rowwise()
                        .mean() /
                    left_out_.variance.array();
}

void SharedProcess::select(const std::vector<Index>& functions) {
  weights_ = MatrixXd(weights_(Eigen::all, functions));
  coefficients_ = MatrixXd(coefficients_(Eigen::all, functions));
  left_out_.residual = MatrixXd(left_out_.residual(Eigen::all, functions));
  left_out_.amplitude = VectorXd(left_out_.amplitude(functions));
  updateLeftOutRatio();
}

void SharedProcess::evaluate(const Eigen::Ref<const VectorXd>& point, Eigen::Ref<VectorXd> values,
                             Workspace& workspace) const {
  MatrixXd& scaled = workspace.scaled;  // (z - x) / l, n x p
  scaled = scaled_points_;
  workspace.squares.setZero(scaled.rows());
  for (Index v = 0; v < scaled.cols(); ++v) {
    scaled.col(v).array() -= point(v) / hyperparameters_.length_scales(v);
    workspace.squares += scaled.col(v).array().square();
  }
  workspace.covariance = workspace.squares;
  workspace.slopes.resize(scaled.rows());
  calcSmoothCovariance(structure_.covariance, workspace.covariance, workspace.slopes);
  workspace.terms = calcTerms(structure_.trend, point);
  values.noalias() = coefficients_.transpose() * workspace.terms;
  values.noalias() += weights_.transpose() * workspace.covariance.matrix();
}

void SharedProcess::derive(const Eigen::Ref<const VectorXd>& point, Eigen::Ref<MatrixXd> jacobian,
                           Workspace& workspace) const {
  const Index unknown = jacobian.cols();
  calcTermDerivatives(structure_.trend, point, workspace.term_derivatives);
  jacobian.noalias() = coefficients_.transpose() * workspace.term_derivatives.leftCols(unknown);
  for (Index v = 0; v < unknown; ++v) {
    workspace.scaled.col(v).array() *= workspace.slopes / hyperparameters_.length_scales(v);
  }
  // Few columns: dot products beat a blocked product, which would copy the weights first.
  jacobian.noalias() += weights_.transpose().lazyProduct(workspace.scaled.leftCols(unknown));
}

double SharedProcess::calcLocalFactor(Workspace& workspace) const {
  // As many neighbours as tell a variance to a third; where all are near, a fifth of the weight is the whole
  // set's.
  constexpr Index kNeighbours = 16;
  constexpr double kOfAll = 4.0;
  const Index n = workspace.squares.size(), reach = std::min(kNeighbours, n) - 1;
  workspace.nearest = workspace.squares;
  std::nth_element(workspace.nearest.data(), workspace.nearest.data() + reach, workspace.nearest.data() + n);
  const double width = std::max(workspace.nearest(reach), std::numeric_limits<double>::min());
  workspace.nearest = (-workspace.squares / width).exp();
  return ((workspace.nearest * left_out_ratio_).sum() + kOfAll) / (workspace.nearest.sum() + kOfAll);
}

void SharedProcess::calcStddev(Eigen::Ref<VectorXd> stddev, Workspace& workspace) const {
  constexpr double kLeast = 1e-14;  // rounding leaves the sum of squares that near to 1
  const Index n = weights_.rows();
  workspace.solved.setZero(factor_.paddedSize());
  workspace.solved.head(n) = workspace.covariance.matrix();
  factor_.solve(workspace.solved.data());
  const auto solved = workspace.solved.head(n);
  const VectorXd rest = workspace.terms - solved_terms_.transpose() * solved;
  const double of_trend = linalg::solveLower(term_factor_, rest).squaredNorm();
  const double variance = std::max(1.0 - solved.squaredNorm(), kLeast) + hyperparameters_.nugget + of_trend;
  stddev = (variance * calcLocalFactor(workspace) * left_out_.amplitude).cwiseSqrt();
}

}  // namespace twinmap::gp
