#include "kernels/surrogate/shared_process.hpp"

#include <algorithm>
#include <cmath>
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

namespace {

void requireSlopes(const MatrixXd& points, const MatrixXd& values, const SlopeData& slopes) {
  if (slopes.countPoints() < 1 || slopes.countPoints() > points.cols() || slopes.variables > points.rows() ||
      slopes.values.cols() != values.cols()) {
    throw std::invalid_argument("SharedProcess: slopes of all functions, at some of the points");
  }
}

JointFit fitOrThrow(const MatrixXd& points, const MatrixXd& values, const SlopeData& slopes,
                    const SharedStructure& structure, const SharedHyperparameters& hyperparameters) {
  requireSlopes(points, values, slopes);
  JointFit fit;
  if (!fitJointly(structure, hyperparameters, points, values, slopes, fit)) {
    throw std::runtime_error("a surrogate's joint covariance of values and slopes is not positive definite");
  }
  return fit;
}

}  // namespace

SharedProcess::SharedProcess(const MatrixXd& points, const MatrixXd& values, const SlopeData& slopes,
                             SharedStructure structure, SharedHyperparameters hyperparameters)
    : SharedProcess(points, slopes, fitOrThrow(points, values, slopes, structure, hyperparameters), structure,
                    hyperparameters) {}

SharedProcess::SharedProcess(const MatrixXd& points, const SlopeData& slopes, JointFit fit,
                             SharedStructure structure, SharedHyperparameters hyperparameters)
    : structure_(structure),
      hyperparameters_(std::move(hyperparameters)),
      slope_points_(slopes.countPoints()),
      slope_variables_(slopes.variables),
      weights_(std::move(fit.weights)),
      coefficients_(std::move(fit.coefficients)) {
  requireSizes(points, fit.residual);
  requireSlopes(points, fit.residual, slopes);
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
    calcPointCovariance(describe(), scaled_points_.row(i).transpose(), workspace.at);
    left_out_.variance(i) = exact::calcLocalVariance(describe(), workspace.at.getView(), static_cast<int>(i));
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
  calcPointCovariance(describe(), workspace.scaled_point, workspace.at);
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
  workspace.rising.resize(jacobian.cols());
  workspace.derivatives.resize(jacobian.cols());
  for (Index j = 0; j < values.size(); ++j) {
    values(j) = calcValue(j, workspace);
    derive(j, jacobian, workspace);
  }
}

exact::smooth_process SharedProcess::describe() const {
  return describeProcess(structure_.covariance, hyperparameters_.nugget, scaled_points_, slope_points_,
                         slope_variables_);
}

double SharedProcess::calcValue(Index function, Workspace& workspace) const {
  const double trend = exact::dot(static_cast<int>(coefficients_.rows()), coefficients_.col(function).data(),
                                  workspace.terms.data());
  return trend + exact::calcFunction(describe(), weights_.col(function).data(), workspace.at.getView());
}

/// Of the function evaluated last.
void SharedProcess::derive(Index function, Eigen::Ref<MatrixXd> jacobian, Workspace& workspace) const {
  exact::calcFunctionSlopes(describe(), weights_.col(function).data(), workspace.at.getView(),
                            static_cast<int>(jacobian.cols()), workspace.rising.data(),
                            workspace.derivatives.data());
  for (Index v = 0; v < jacobian.cols(); ++v) {
    const double trend =
        exact::dot(static_cast<int>(coefficients_.rows()), coefficients_.col(function).data(),
                   workspace.term_derivatives.col(v).data());
    jacobian(function, v) = workspace.derivatives(v) / hyperparameters_.length_scales(v) + trend;
  }
}

exact::own_variance SharedProcess::describeOwnVariance() const {
  return {static_cast<int>(factor_.paddedSize()), static_cast<int>(term_factor_.rows()),
          factor_.getTiles().data(), solved_terms_.data(), term_factor_.data()};
}

double SharedProcess::calcOwnVariance(Workspace& workspace) const {
  workspace.rest.resize(term_factor_.rows());
  return exact::calcOwnVariance(describe(), describeOwnVariance(), workspace.terms.data(),
                                workspace.at.getView(), workspace.rest.data());
}

void SharedProcess::scaleStddev(double variance, Eigen::Ref<VectorXd> stddev) const {
  for (Index j = 0; j < stddev.size(); ++j) {
    stddev(j) = std::sqrt(variance * left_out_.amplitude(j));  // Eigen's own is not rounded correctly
  }
}

void SharedProcess::calcStddev(Eigen::Ref<VectorXd> stddev, Workspace& workspace) const {
  const exact::smooth_process process = describe();
  const double variance = slope_points_ > 0 ? exact::calcLocalVariance(process, workspace.at.getView(), -1)
                                            : calcOwnVariance(workspace);
  scaleStddev(variance * exact::calcLocalFactor(process, left_out_ratio_.data(), workspace.at.getView()),
              stddev);
}

void SharedProcess::evaluateMany(const Eigen::Ref<const MatrixXd>& points, Eigen::Ref<MatrixXd> values,
                                 Eigen::Ref<MatrixXd> stddev, Workspace& workspace) const {
  constexpr Index kBlock = 64;  // columns of covariances that stay in the second cache with 1000 points
  for (Index first = 0; first < points.cols(); first += kBlock) {
    const Index count = std::min(kBlock, points.cols() - first);
    evaluateBlock(points.middleCols(first, count), values.middleCols(first, count),
                  stddev.middleCols(first, count), workspace);
  }
}

void SharedProcess::evaluateBlock(const Eigen::Ref<const MatrixXd>& points, Eigen::Ref<MatrixXd> values,
                                  Eigen::Ref<MatrixXd> stddev, Workspace& workspace) const {
  const exact::smooth_process process = describe();
  const bool own = slope_points_ == 0;
  workspace.factors.resize(points.cols());
  workspace.many_terms.resize(coefficients_.rows(), points.cols());
  workspace.solved.setZero(factor_.paddedSize(), points.cols());
  for (Index i = 0; i < points.cols(); ++i) {
    evaluate(points.col(i), values.col(i), workspace);
    const exact::smooth_point at = workspace.at.getView();
    workspace.factors(i) = exact::calcLocalFactor(process, left_out_ratio_.data(), at);
    if (own) {
      workspace.many_terms.col(i) = workspace.terms;
      workspace.solved.col(i).head(scaled_points_.rows()) = workspace.at.values;
    } else {
      scaleStddev(exact::calcLocalVariance(process, at, -1) * workspace.factors(i), stddev.col(i));
    }
  }
  if (!own) {
    return;
  }
  factor_.solve(workspace.solved);
  workspace.rest.resize(term_factor_.rows());
  for (Index i = 0; i < points.cols(); ++i) {
    const double variance =
        exact::finishOwnVariance(process, describeOwnVariance(), workspace.many_terms.col(i).data(),
                                 workspace.solved.col(i).data(), workspace.rest.data());
    scaleStddev(variance * workspace.factors(i), stddev.col(i));
  }
}

}  // namespace twinmap::gp
