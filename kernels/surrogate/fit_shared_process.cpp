#include "kernels/surrogate/fit_shared_process.hpp"

#include <cmath>
#include <stdexcept>

#include "kernels/gp/optimizer.hpp"
#include "kernels/gp/sparse/inducing_points.hpp"
#include "kernels/surrogate/left_out_density.hpp"

namespace twinmap::gp {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

// Few points tell length scales, and an evaluation costs their number cubed.
// Of variables within [-1, 1]: below, nothing is learnt between points; above, a process is a polynomial,
// which the trend is already, and K singular.
constexpr double kShortest = 0.2, kLongest = 6.0;
// Below, K has no Cholesky factor; above, there is no smooth function.
constexpr double kMinNugget = 1e-10, kMaxNugget = 1e-1;
constexpr int kAllEvaluations = 8;  // with all points, where they are more
constexpr int kTrialEvaluations = 12, kFirstEvaluations = 30, kFurtherEvaluations = 20, kAdaptEvaluations = 8;
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
  box.lower(variables) = std::log(kMinNugget);
  box.upper(variables) = std::log(kMaxNugget);
  box.prior_mean = box.prior_precision = VectorXd::Zero(variables + 1);
  return box;
}

/// The points that are searched on.
struct SearchData {
  MatrixXd points, values;
};

SearchData takeSpreadValues(const MatrixXd& points, const MatrixXd& values) {
  const std::vector<Index> taken = spreadIndices(points.cols(), kSearchPoints);
  return {points(Eigen::all, taken), values(taken, Eigen::all)};
}

struct Searched : SharedChoice {
  bool converged;  ///< within kTolerance
};

Searched search(const SearchData& data, const SharedStructure& structure, const VectorXd& start,
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
  return {{structure, fromLog(result.end), result.objective}, result.converged};
}

/// The better of two beginnings: functions about as smooth as the box is wide, and functions that change
/// within it. The search would not get from the former to the latter: between them all points are far apart.
SharedChoice searchFromStarts(const SearchData& data, const SharedStructure& structure, StopFlag stop) {
  constexpr double kLengthScales[] = {2.0, 0.7}, kNuggets[] = {1e-6, 1e-4};
  const Index p = data.points.rows();
  const auto try_from = [&](int i) {
    const SharedHyperparameters start{VectorXd::Constant(p, kLengthScales[i]), kNuggets[i]};
    return search(data, structure, toLog(start), kTrialEvaluations, stop);
  };
  const Searched smooth = try_from(0), changing = try_from(1);
  const Searched& better = changing.negative_log_density < smooth.negative_log_density ? changing : smooth;
  return better.converged ? better
                          : search(data, structure, toLog(better.hyperparameters), kFirstEvaluations, stop);
}

void requireFound(const SharedChoice& choice) {
  if (!std::isfinite(choice.negative_log_density)) {
    throw std::runtime_error("no covariance of the surrogate is positive definite");
  }
}

}  // namespace

SharedChoice chooseOnSpread(const MatrixXd& points, const MatrixXd& values, StopFlag stop) {
  const Index p = points.rows();
  if (points.cols() < p + 3) {
    throw std::invalid_argument("a surrogate needs more simulations than parameters");
  }
  const SearchData data = takeSpreadValues(points, values);
  SharedChoice best = searchFromStarts(data, {}, stop);
  const VectorXd found = toLog(best.hyperparameters);
  const auto improve_by = [&](const SharedStructure& structure) {
    const SharedChoice other = search(data, structure, found, kFurtherEvaluations, stop);
    if (other.negative_log_density < best.negative_log_density) {
      best = other;
    }
  };
  improve_by({SmoothCovariance::kMatern52, Trend::kLinear});
  const bool is_rough = best.structure.covariance == SmoothCovariance::kMatern52;
  if (data.points.cols() >= kPointsPerTerm * countTerms(Trend::kQuadratic, p)) {
    improve_by({SmoothCovariance::kSquaredExponential, Trend::kQuadratic});
    // Functions that are smooth but for a linear trend are so but for a quadratic one.
    if (is_rough) {
      improve_by({SmoothCovariance::kMatern52, Trend::kQuadratic});
    }
  }
  requireFound(best);
  return best;
}

SharedChoice finishOnAll(const SharedChoice& found, const MatrixXd& points, const MatrixXd& values,
                         StopFlag stop) {
  return points.cols() > kSearchPoints
             ? search({points, values}, found.structure, toLog(found.hyperparameters), kAllEvaluations, stop)
             : found;
}

SharedChoice chooseSharedProcess(const MatrixXd& points, const MatrixXd& values, StopFlag stop) {
  return finishOnAll(chooseOnSpread(points, values, stop), points, values, stop);
}

SharedChoice adaptSharedProcess(const SharedChoice& similar, const MatrixXd& points, const MatrixXd& values,
                                StopFlag stop) {
  if (points.cols() > kSearchPoints) {
    return similar;
  }
  const SharedChoice adapted =
      search({points, values}, similar.structure, toLog(similar.hyperparameters), kAdaptEvaluations, stop);
  requireFound(adapted);
  return adapted;
}

}  // namespace twinmap::gp
