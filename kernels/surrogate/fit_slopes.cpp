#include "kernels/surrogate/fit_slopes.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "kernels/gp/sparse/inducing_points.hpp"
#include "kernels/surrogate/joint_fit.hpp"

namespace twinmap::gp {

using Eigen::Index;
using Eigen::MatrixXd;

namespace {

// Tells length scales as well as 900 do: on eight mechanisms the surrogate's sds stay within 3 % both ways,
// and training takes 20 % less.
constexpr Index kSearchRows = 500;
// A joint covariance is worse conditioned than that of values; above, the slopes say nothing.
constexpr double kMinSlopeNugget = 1e-9, kMaxSlopeNugget = 10.0;
constexpr int kMaxFits = 14;

struct SlopeSamples {
  MatrixXd points, values;
  SlopeData slopes;
};

/// Points with slopes, spread over all that have them.
SlopeSamples takeSpreadSlopes(const MatrixXd& points, const MatrixXd& values, const SlopeData& slopes) {
  const Index m = slopes.countPoints(), most = std::max<Index>(1, kSearchRows / (1 + slopes.variables));
  const std::vector<Index> taken = spreadIndices(m, std::min(m, most));
  SlopeSamples samples{points(Eigen::all, taken), values(taken, Eigen::all), {{}, slopes.variables}};
  const auto count = static_cast<Index>(taken.size());
  samples.slopes.values.resize(slopes.variables * count, values.cols());
  for (Index v = 0; v < slopes.variables; ++v) {
    samples.slopes.values.middleRows(v * count, count) =
        slopes.values.middleRows(v * m, m)(taken, Eigen::all);
  }
  return samples;
}

double calcDensity(const SlopeSamples& samples, const SharedChoice& choice) {
  JointFit fit;
  const bool ok = fitJointly(
      choice.structure, choice.hyperparameters, samples.points, samples.values,
      choice.structure.slopes ? samples.slopes : SlopeData{MatrixXd(0, samples.values.cols()), 0}, fit);
  return ok ? calcLeftOutDensity(fit) : std::numeric_limits<double>::infinity();
}

/// A change of a choice that is tried, and again while it helps.
struct Move {
  double length_factor = 1.0, nugget_factor = 1.0, slope_nugget_factor = 1.0;
  bool other_covariance = false;
};

// Length scales that values alone suggest are within a factor of two of the best for both; nuggets may be off
// by orders of magnitude.
constexpr std::array<Move, 7> kMoves{{{1.0, 1.0, 30.0, false},
                                      {1.0, 1.0, 1.0, true},
                                      {1.4, 1.0, 1.0, false},
                                      {1.0 / 1.4, 1.0, 1.0, false},
                                      {1.0, 0.1, 0.1, false},
                                      {1.0, 10.0, 1.0, false},
                                      {1.0, 1.0, 1.0 / 5.0, false}}};

SharedChoice apply(const Move& move, SharedChoice choice) {
  SharedHyperparameters& numbers = choice.hyperparameters;
  numbers.length_scales *= move.length_factor;
  numbers.nugget = std::clamp(numbers.nugget * move.nugget_factor, kMinSlopeNugget, kMaxSlopeNugget);
  numbers.slope_nugget =
      std::clamp(numbers.slope_nugget * move.slope_nugget_factor, kMinSlopeNugget, kMaxSlopeNugget);
  if (move.other_covariance) {
    choice.structure.covariance = choice.structure.covariance == SmoothCovariance::kMatern52
                                      ? SmoothCovariance::kSquaredExponential
                                      : SmoothCovariance::kMatern52;
  }
  return choice;
}

/// The best of the moves from a choice, each repeated while it helps.
SharedChoice improve(const SlopeSamples& samples, SharedChoice best, StopFlag stop) {
  int fits = 0;
  for (const Move& move : kMoves) {
    bool better = true;
    while (better && fits++ < kMaxFits) {
      throwIfStopped(stop);
      SharedChoice tried = apply(move, best);
      tried.negative_log_density = calcDensity(samples, tried);
      better = tried.negative_log_density < best.negative_log_density;
      if (better) {
        best = tried;
      }
      better = better && !move.other_covariance;
    }
  }
  return best;
}

}  // namespace

SharedChoice chooseWithSlopes(const SharedChoice& by_values, const MatrixXd& points, const MatrixXd& values,
                              const SlopeData& slopes, StopFlag stop) {
  const SlopeSamples samples = takeSpreadSlopes(points, values, slopes);
  if (samples.points.cols() < points.rows() + 3) {
    return by_values;
  }
  SharedChoice first = by_values;
  first.structure.slopes = true;
  if (samples.points.cols() <= countTerms(first.structure.trend, points.rows())) {
    first.structure.trend = Trend::kLinear;
  }
  first.hyperparameters.nugget = std::max(by_values.hyperparameters.nugget, kMinSlopeNugget);
  first.hyperparameters.slope_nugget = first.hyperparameters.nugget;
  first.negative_log_density = calcDensity(samples, first);
  const SharedChoice best = improve(samples, first, stop);
  return best.negative_log_density < calcDensity(samples, by_values) ? best : by_values;
}

}  // namespace twinmap::gp
