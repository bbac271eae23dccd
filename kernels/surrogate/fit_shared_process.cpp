#include "kernels/surrogate/fit_shared_process.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>

#include "kernels/gp/optimizer.hpp"
#include "kernels/sparse/inducing_points.hpp"
#include "kernels/surrogate/left_out_density.hpp"

namespace twinmap::gp {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

// Few points tell length scales, and an evaluation costs their number cubed.
constexpr Index kSearchPoints = 300;
// Of variables within [-1, 1]: below, nothing is learnt between points; above, a process is a polynomial,
// which the trend is already, and K singular.
constexpr double kShortest = 0.2, kLongest = 6.0, kStart = 2.0;
// Below, K has no Cholesky factor; above, there is no smooth function.
constexpr double kLeastNugget = 1e-10, kMostNugget = 1e-1, kStartNugget = 1e-6;
constexpr int kFirstEvaluations = 40, kFurtherEvaluations = 20, kAdaptEvaluations = 8;
constexpr double kTolerance = 0.002;  // nats a point and search: less changes no inference
constexpr Index kPointsPerTerm = 4;   // below, the coefficients of a quadratic trend are guesses

SharedHyperparameters fromLog(const VectorXd& point) {
  const Index p = point.size() - 1;
  return {point.head(p).array().exp(), std::exp(point(p))};
}

VectorXd toLog(const SharedHyperparameters& hyperparameters) {
  VectorXd point(hyperparameters.length_scales.size() + 1);
  point << hyperparameters.length_scales.array().log().matrix(), std::log(hyperparameters.nugget);
  return point;
}

SearchBox makeBox(Index variables) {
  SearchBox box;
  box.lower = VectorXd::Constant(variables + 1, std::log(kShortest));
  box.upper = VectorXd::Constant(variables + 1, std::log(kLongest));
  box.lower(variables) = std::log(kLeastNugget);
  box.upper(variables) = std::log(kMostNugget);
  box.prior_mean = box.prior_precision = VectorXd::Zero(variables + 1);
  return box;
}

/// The points that are searched on.
struct SearchData {
  MatrixXd points, values;
};

SearchData takeSpread(const MatrixXd& points, const MatrixXd& values) {
  const std::vector<Index> taken = spreadIndices(points.cols(), kSearchPoints);
  return {points(Eigen::all, taken), values(taken, Eigen::all)};
}

SharedChoice search(const SearchData& data, const SharedStructure& structure, const VectorXd& start,
                    int evaluations, StopFlag stop) {
  LeftOutDensity density(data.points, data.values, structure);
  const Objective objective = [&](const VectorXd& point, VectorXd& gradient) {
    LikelihoodEvaluation evaluation;
    evaluation.ok = density.evaluate(fromLog(point), evaluation.nlml, gradient);
    return evaluation;
  };
  const Index n = data.points.cols();
  SearchLimits limits;
  limits.max_evaluations = evaluations;
  limits.tolerance = kTolerance * static_cast<double>(n);
  limits.stop = stop;
  const SearchResult result = minimize(objective, n, start, makeBox(data.points.rows()), limits);
  return {structure, fromLog(result.end), result.objective};
}

void requireFound(const SharedChoice& choice) {
  if (!std::isfinite(choice.negative_log_density)) {
    throw std::runtime_error("no covariance of the surrogate is positive definite");
  }
}

}  // namespace

SharedChoice chooseSharedProcess(const MatrixXd& points, const MatrixXd& values, StopFlag stop) {
  const Index p = points.rows();
  if (points.cols() < p + 3) {
    throw std::invalid_argument("a surrogate needs more simulations than parameters");
  }
  const SearchData data = takeSpread(points, values);
  VectorXd start = VectorXd::Constant(p + 1, std::log(kStart));
  start(p) = std::log(kStartNugget);
  SharedChoice best = search(data, {}, start, kFirstEvaluations, stop);
  const VectorXd found = toLog(best.hyperparameters);
  for (const Trend trend : {Trend::kLinear, Trend::kQuadratic}) {
    for (const SmoothCovariance covariance :
         {SmoothCovariance::kSquaredExponential, SmoothCovariance::kMatern52}) {
      const bool done = trend == Trend::kLinear && covariance == SmoothCovariance::kSquaredExponential;
      if (done ||
          (trend == Trend::kQuadratic && data.points.cols() < kPointsPerTerm * countTerms(trend, p))) {
        continue;
      }
      const SharedChoice other = search(data, {covariance, trend}, found, kFurtherEvaluations, stop);
      if (other.negative_log_density < best.negative_log_density) {
        best = other;
      }
    }
  }
  requireFound(best);
  return best;
}

SharedChoice adaptSharedProcess(const SharedChoice& similar, const MatrixXd& points, const MatrixXd& values,
                                StopFlag stop) {
  const SharedChoice adapted = search(takeSpread(points, values), similar.structure,
                                      toLog(similar.hyperparameters), kAdaptEvaluations, stop);
  requireFound(adapted);
  return adapted;
}

}  // namespace twinmap::gp
