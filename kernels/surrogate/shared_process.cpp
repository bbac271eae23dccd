#include "kernels/surrogate/shared_process.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "kernels/linalg/decompositions.hpp"
#include "kernels/surrogate/joint_fit.hpp"

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

void SharedProcess::requireSizes(const MatrixXd& points, const MatrixXd& values) const {
  if (values.rows() != points.cols() || hyperparameters_.length_scales.size() != points.rows() ||
      points.cols() <= countTerms(structure_.trend, points.rows())) {
    throw std::invalid_argument("SharedProcess: more points than terms, a row of values for each");
  }
}

SharedProcess::SharedProcess(const MatrixXd& points, const MatrixXd& values, SharedStructure structure,
                             SharedHyperparameters hyperparameters)
    : structure_(structure), hyperparameters_(std::move(hyperparameters)) {
  requireSizes(points, values);
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
      slope_points_(parts.slope_points),
      slope_variables_(parts.slope_variables),
      weights_(std::move(parts.weights)),
      coefficients_(std::move(parts.coefficients)),
      solved_terms_(std::move(parts.solved_terms)),
      term_factor_(std::move(parts.term_factor)),
      local_variance_(structure_.covariance, hyperparameters_.nugget),
      left_out_ratio_(std::move(parts.left_out_ratio)) {
  left_out_.amplitude = std::move(parts.amplitude);
  if (slope_points_ == 0) {
    factor_ = linalg::PackedLower::fromTiles(std::move(parts.factor_tiles));
  }
  if (!fitTogether()) {
    throw std::invalid_argument("SharedProcess: parts that do not fit each other");
  }
}

bool SharedProcess::fitTogether() const {
  const Index n = scaled_points_.rows(), p = scaled_points_.cols(), r = weights_.cols();
  const Index q = countTerms(structure_.trend, p);
  const bool own_variance = factor_.paddedSize() >= n && solved_terms_.rows() == n &&
                            solved_terms_.cols() == q && term_factor_.rows() == q && term_factor_.cols() == q;
  return hyperparameters_.length_scales.size() == p && slope_points_ >= 0 && slope_points_ <= n &&
         slope_variables_ >= 0 && slope_variables_ <= p &&
         weights_.rows() == n + slope_points_ * slope_variables_ && coefficients_.rows() == q &&
         coefficients_.cols() == r && left_out_.amplitude.size() == r && left_out_ratio_.size() == n &&
         (slope_points_ > 0 || own_variance);
}

SharedProcessParts SharedProcess::getParts() const {
  return {structure_,          hyperparameters_,
          scaled_points_,      slope_points_,
          slope_variables_,    weights_,
          coefficients_,       slope_points_ > 0 ? VectorXd() : VectorXd(factor_.getTiles()),
          solved_terms_,       term_factor_,
          left_out_.amplitude, left_out_ratio_};
}

SharedProcess::SharedProcess(const MatrixXd& points, const MatrixXd& values, const SlopeData& slopes,
                             SharedStructure structure, SharedHyperparameters hyperparameters)
    : structure_(structure),
      hyperparameters_(std::move(hyperparameters)),
      slope_points_(slopes.countPoints()),
      slope_variables_(slopes.variables),
      local_variance_(structure.covariance, hyperparameters_.nugget) {
  requireSizes(points, values);
  if (slope_points_ < 1 || slope_points_ > points.cols() || slope_variables_ > points.rows() ||
      slopes.values.cols() != values.cols()) {
    throw std::invalid_argument("SharedProcess: slopes of all functions, at some of the points");
  }
  JointFit fit;
  if (!fitJointly(structure_, hyperparameters_, points, values, slopes, fit)) {
    throw std::runtime_error("a surrogate's joint covariance of values and slopes is not positive definite");
  }
  coefficients_ = std::move(fit.coefficients);
  weights_ = std::move(fit.weights);
  scaled_points_ = points.transpose() * hyperparameters_.length_scales.cwiseInverse().asDiagonal();
  leaveOutLocally(points, fit.residual);
  updateLeftOutRatio();
}

/// The residuals are of the whole process, the variance that of the nearest points.
void SharedProcess::leaveOutLocally(const MatrixXd& points, const MatrixXd& residual) {
  const Index n = points.cols();
  Workspace workspace;
  left_out_.residual = residual;
  left_out_.variance.resize(n);
  for (Index i = 0; i < n; ++i) {
    calcPointCovariance(structure_.covariance, scaled_points_, scaled_points_.row(i).transpose(), false,
                        workspace.at);
    left_out_.variance(i) =
        local_variance_.calc(scaled_points_, workspace.at.squares, workspace.at.values, i, workspace.local);
  }
  left_out_.amplitude =
      (residual.array().square().colwise() / left_out_.variance.array()).colwise().mean().transpose();
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

void SharedProcess::prepare(const Eigen::Ref<const VectorXd>& point, Workspace& workspace) const {
  workspace.scaled_point = point.cwiseQuotient(hyperparameters_.length_scales);
  calcPointCovariance(structure_.covariance, scaled_points_, workspace.scaled_point, slope_points_ > 0,
                      workspace.at);
  workspace.terms = calcTerms(structure_.trend, point);
}

void SharedProcess::evaluate(const Eigen::Ref<const VectorXd>& point, Eigen::Ref<VectorXd> values,
                             Workspace& workspace) const {
  prepare(point, workspace);
  for (Index j = 0; j < values.size(); ++j) {
    values(j) = calcValue(j, workspace);
  }
}

void SharedProcess::linearize(const Eigen::Ref<const VectorXd>& point, Eigen::Ref<VectorXd> values,
                              Eigen::Ref<MatrixXd> jacobian, Workspace& workspace) const {
  prepare(point, workspace);
  calcTermDerivatives(structure_.trend, point, workspace.term_derivatives);
  jacobian.noalias() = coefficients_.leftCols(jacobian.rows()).transpose() *
                       workspace.term_derivatives.leftCols(jacobian.cols());
  for (Index j = 0; j < values.size(); ++j) {
    values(j) = calcValue(j, workspace);
    addDerivatives(j, jacobian, workspace);
  }
}

/// Leaves the sums of the slopes' weights, which the derivatives need too.
double SharedProcess::calcValue(Index function, Workspace& workspace) const {
  const Index n = scaled_points_.rows(), m = slope_points_;
  const auto weights = weights_.col(function);
  double value =
      coefficients_.col(function).dot(workspace.terms) + workspace.at.values.matrix().dot(weights.head(n));
  if (m > 0) {
    workspace.sums.calc(workspace.at, Eigen::Map<const MatrixXd>(weights.tail(weights.size() - n).data(), m,
                                                                 slope_variables_));
    value += (workspace.at.slopes.head(m) * workspace.sums.projected).sum();
  }
  return value;
}

void SharedProcess::addDerivatives(Index function, Eigen::Ref<MatrixXd> jacobian,
                                   Workspace& workspace) const {
  const Index n = scaled_points_.rows(), m = slope_points_;
  const PointCovariance& at = workspace.at;
  workspace.falling = at.slopes * weights_.col(function).head(n).array();
  if (m > 0) {
    workspace.falling.head(m) += at.curvatures.head(m) * workspace.sums.projected;
  }
  workspace.falls.resize(jacobian.cols());
  sumDifferences(at, workspace.falling, workspace.falls);
  for (Index v = 0; v < jacobian.cols(); ++v) {
    const double rises = v < slope_variables_ ? workspace.sums.weighted(v) : 0.0;
    jacobian(function, v) += (rises - workspace.falls(v)) / hyperparameters_.length_scales(v);
  }
}

double SharedProcess::calcLocalFactor(Workspace& workspace) const {
  // As many neighbours as tell a variance to a third; where all are near, a fifth of the weight is the whole
  // set's.
  constexpr Index kNeighbours = 16;
  constexpr double kOfAll = 4.0;
  const Index n = workspace.at.squares.size(), reach = std::min(kNeighbours, n) - 1;
  workspace.nearest = workspace.at.squares;
  std::nth_element(workspace.nearest.data(), workspace.nearest.data() + reach, workspace.nearest.data() + n);
  const double width = std::max(workspace.nearest(reach), std::numeric_limits<double>::min());
  workspace.nearest = (-workspace.at.squares / width).exp();
  return ((workspace.nearest * left_out_ratio_).sum() + kOfAll) / (workspace.nearest.sum() + kOfAll);
}

double SharedProcess::calcOwnVariance(Workspace& workspace) const {
  constexpr double kLeast = 1e-14;  // rounding leaves the sum of squares that near to 1
  const Index n = weights_.rows();
  workspace.solved.setZero(factor_.paddedSize());
  workspace.solved.head(n) = workspace.at.values.matrix();
  factor_.solve(workspace.solved.data());
  const auto solved = workspace.solved.head(n);
  const VectorXd rest = workspace.terms - solved_terms_.transpose() * solved;
  const double of_trend = linalg::solveLower(term_factor_, rest).squaredNorm();
  return std::max(1.0 - solved.squaredNorm(), kLeast) + hyperparameters_.nugget + of_trend;
}

void SharedProcess::calcStddev(Eigen::Ref<VectorXd> stddev, Workspace& workspace) const {
  const double variance = slope_points_ > 0 ? local_variance_.calc(scaled_points_, workspace.at.squares,
                                                                   workspace.at.values, -1, workspace.local)
                                            : calcOwnVariance(workspace);
  stddev = (variance * calcLocalFactor(workspace) * left_out_.amplitude).cwiseSqrt();
}

}  // namespace twinmap::gp
