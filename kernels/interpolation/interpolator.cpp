#include "kernels/interpolation/interpolator.hpp"

#include <nlopt.h>

#include <cmath>
#include <memory>
#include <stdexcept>
#include <vector>

#include "kernels/linalg/decompositions.hpp"
#include "kernels/sparse/inducing_points.hpp"

namespace twinmap::gp {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

// Few points tell length scales, and an evaluation costs their number cubed.
constexpr Index kSearchPoints = 300;
constexpr int kMostEvaluations = 120;  // the search ends after some 100 by itself
// Length scales, of variables within [-1, 1]: below, nothing is learnt between the points; above, a function
// is a polynomial of low order, and K singular.
constexpr double kShortest = 0.2, kLongest = 50.0;
constexpr double kStart = 1.5;       // of the order of the box
constexpr double kFirstStep = 0.7;   // of the logarithm: a factor of two
constexpr double kTolerance = 0.02;  // of the logarithm: 2 % of a length scale change no value visibly
constexpr double kNugget = 1e-10;    // keeps K positive definite; far below any noise

void require(bool condition, const char* message) {
  if (!condition) {
    throw std::invalid_argument(std::string("Interpolator: ") + message);
  }
}

MatrixXd calcCovariance(const MatrixXd& points, const VectorXd& length_scales) {
  const MatrixXd scaled = length_scales.cwiseInverse().asDiagonal() * points;
  const VectorXd norms = scaled.colwise().squaredNorm();
  MatrixXd covariance = -2.0 * scaled.transpose() * scaled;
  covariance.colwise() += norms;
  covariance.rowwise() += norms.transpose();
  covariance = (-0.5 * covariance.array().max(0.0)).exp();
  covariance.diagonal().array() += kNugget;
  return covariance;
}

struct Solution {
  MatrixXd weights;            // n x r
  VectorXd left_out_variance;  // r
};

/// The residual of a point that is left out is its weight over its entry of K^-1's diagonal (Rasmussen and
/// Williams eq. 5.12). False if K is not positive definite.
bool solve(const MatrixXd& points, const MatrixXd& centered, const VectorXd& length_scales,
           Solution& solution) {
  const linalg::Cholesky factor = linalg::calcCholesky(calcCovariance(points, length_scales));
  if (!factor.positive_definite) {
    return false;
  }
  solution.weights = linalg::solveCholesky(factor.lower, centered.transpose());
  const MatrixXd inverse_factor =
      linalg::solveLower(factor.lower, MatrixXd::Identity(points.cols(), points.cols()));
  const Eigen::ArrayXd precision = inverse_factor.colwise().squaredNorm();
  solution.left_out_variance =
      (solution.weights.array().colwise() / precision).square().colwise().mean().transpose();
  return solution.left_out_variance.allFinite();
}

struct Search {
  const MatrixXd& points;
  const MatrixXd& centered;
  Solution solution;
};

double evaluateLengthScales(unsigned count, const double* logs, double*, void* data) {
  constexpr double kRejected = 1e6;  // worse than any sum of logarithms, yet finite for the optimizer
  Search& search = *static_cast<Search*>(data);
  const VectorXd length_scales = Eigen::Map<const Eigen::ArrayXd>(logs, count).exp();
  if (!solve(search.points, search.centered, length_scales, search.solution)) {
    return kRejected;
  }
  return search.solution.left_out_variance.array().log1p().sum();
}

VectorXd findLengthScales(const MatrixXd& points, const MatrixXd& centered) {
  const auto count = static_cast<unsigned>(points.rows());
  Search search{points, centered, {}};
  // BOBYQA needs two variables.
  const nlopt_algorithm algorithm = count > 1 ? NLOPT_LN_BOBYQA : NLOPT_LN_SBPLX;
  const std::unique_ptr<nlopt_opt_s, void (*)(nlopt_opt)> optimizer(nlopt_create(algorithm, count),
                                                                    nlopt_destroy);
  nlopt_set_min_objective(optimizer.get(), evaluateLengthScales, &search);
  nlopt_set_lower_bounds1(optimizer.get(), std::log(kShortest));
  nlopt_set_upper_bounds1(optimizer.get(), std::log(kLongest));
  nlopt_set_initial_step1(optimizer.get(), kFirstStep);
  nlopt_set_xtol_abs1(optimizer.get(), kTolerance);
  nlopt_set_maxeval(optimizer.get(), kMostEvaluations);
  std::vector<double> logs(count, std::log(kStart));
  double best = 0.0;
  nlopt_optimize(optimizer.get(), logs.data(), &best);
  return Eigen::Map<const Eigen::ArrayXd>(logs.data(), count).exp();
}

}  // namespace

Interpolator::Interpolator(InterpolatorParts parts) : parts_(std::move(parts)) {
  const Index n = parts_.points.cols(), r = parts_.mean.size();
  require(n > 0 && parts_.length_scales.size() == parts_.points.rows(), "a length scale per variable");
  require(parts_.weights.rows() == n && parts_.weights.cols() == r && parts_.left_out_variance.size() == r,
          "weights must be points x functions");
  require(parts_.points.allFinite() && parts_.weights.allFinite() && parts_.mean.allFinite() &&
              parts_.left_out_variance.allFinite() && (parts_.length_scales.array() > 0.0).all(),
          "every number must be finite, length scales positive");
  scaled_points_ = parts_.points.transpose() * parts_.length_scales.cwiseInverse().asDiagonal();
}

void Interpolator::evaluate(const Eigen::Ref<const VectorXd>& point, Workspace& workspace) const {
  MatrixXd& scaled = workspace.scaled;  // (z - x) / l, n x p
  scaled = scaled_points_;
  for (Index v = 0; v < getVariableCount(); ++v) {
    scaled.col(v).array() -= point(v) / parts_.length_scales(v);
  }
  workspace.covariance = scaled.col(0).array().square();
  for (Index v = 1; v < getVariableCount(); ++v) {
    workspace.covariance += scaled.col(v).array().square();
  }
  workspace.covariance = (-0.5 * workspace.covariance).exp();
  workspace.values = parts_.mean;
  workspace.values.noalias() += parts_.weights.transpose() * workspace.covariance.matrix();
  for (Index v = 0; v < getVariableCount(); ++v) {
    scaled.col(v).array() *= workspace.covariance / parts_.length_scales(v);
  }
  // Few columns: dot products beat a blocked product, which would copy the weights first.
  workspace.jacobian.noalias() = parts_.weights.transpose().lazyProduct(scaled);
}

Interpolator fitInterpolator(const MatrixXd& points, const MatrixXd& values) {
  require(points.cols() == values.cols() && points.cols() > points.rows() + 1 && points.rows() > 0,
          "more points than variables, and a column of values for each");
  require(points.allFinite() && values.allFinite(), "every number must be finite");
  InterpolatorParts parts;
  parts.points = points;
  parts.mean = values.rowwise().mean();
  const MatrixXd centered = values.colwise() - parts.mean;
  const std::vector<Index> searched = spreadIndices(points.cols(), kSearchPoints);
  parts.length_scales = findLengthScales(points(Eigen::all, searched), centered(Eigen::all, searched));
  Solution solution;
  require(solve(points, centered, parts.length_scales, solution), "the covariance is not positive definite");
  parts.weights = solution.weights;
  parts.left_out_variance = solution.left_out_variance;
  return Interpolator(std::move(parts));
}

}  // namespace twinmap::gp
