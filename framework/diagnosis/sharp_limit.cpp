#include "framework/diagnosis/sharp_limit.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "framework/diagnosis/problem/score_test.hpp"
#include "framework/estimation/levels.hpp"
#include "framework/experiment/model/parameter_box.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

/// So often bounds fall at most: by 15625 where the reach is 5.
constexpr int kFalls = 6;

/// chi-square that a fall of the bounds may change where recordings do not tell. It matters little: with
/// bounds at 1e-4, 5e-4 and 1e-3 rad/s 57, 56 and 56 of 60 intervals held (bench/README.md, "Dry friction").
constexpr double kFlat = 1.0;

/// Whether a scale lies far above `lower` by the linear model. noise: its variance, in that which is stated.
bool isExcluded(const LinearizedRecordings& linear, Index scale, double above, double noise) {
  const Index u = linear.jacobian.cols();
  const ScoreTest test(linear.residual, linear.jacobian(Eigen::all, listOthers(u, scale, 1)),
                       linear.jacobian.col(scale));
  const TermScore score = test.calcScore(0, kInfinity);
  return score.visible && above > std::sqrt(noise) * kBasinReach * score.stddev;
}

/// The bound at which a descent ends, and the fits on the way.
struct Descent {
  double lower = 0.0;
  std::vector<RecordingFit> fits;  ///< each sharper than the one before

  const RecordingFit& findBest() const {
    return *std::min_element(fits.begin(), fits.end(), [](const RecordingFit& a, const RecordingFit& b) {
      return a.chi_square < b.chi_square;
    });
  }
  /// The first that is hardly worse than the best: sharp laws take time.
  const RecordingFit& findSoftest(double noise) const {
    const double most = findBest().chi_square + noise * kFlat;
    return *std::find_if(fits.begin(), fits.end(),
                         [most](const RecordingFit& one) { return one.chi_square < most; });
  }
};

/// The other parameters follow as the scale falls.
Descent descend(const RecordingsProblem& problem, Index scale, double lower, double reach, double noise,
                const RecordingFit& fit) {
  Descent descent{lower, {fit}};
  for (int fall = 0; fall <= kFalls; ++fall) {
    const RecordingFit before = descent.fits.back();
    VectorXd at = before.point;
    at[scale] = lower * std::pow(reach, -fall);
    const RecordingFit held = problem.fit(at, scale);
    if (held.point.size() == 0) {
      return descent;
    }
    descent.lower = held.point[scale];
    descent.fits.push_back(held);
    const RecordingFit& best = descent.findBest();
    const bool is_below = before.point[scale] <= best.point[scale] && fall > 0;
    if (held.chi_square > best.chi_square + noise * kBasinReach * kBasinReach ||
        (is_below && std::abs(held.chi_square - before.chi_square) < noise * kFlat)) {
      return descent;
    }
  }
  return descent;
}

void follow(const RecordedFeatures& recordings, Index scale, double reach, ExperimentSpec& experiment,
            RecordingFit& fit) {
  const auto number = static_cast<std::size_t>(scale);
  Bounds bounds = experiment.model.parameters[number].bounds;
  const double lower = bounds.lower;
  const LinearizedRecordings linear = RecordingsProblem(experiment, recordings).linearize(fit.point);
  const auto degrees = static_cast<double>(std::max<Index>(1, linear.residual.size() - fit.point.size()));
  const double noise = std::max(1.0, fit.chi_square / degrees);  // as large as the residual
  if (isExcluded(linear, scale, fit.point[scale] - lower, noise)) {
    return;
  }
  const auto setLower = [&](double value) {
    bounds.lower = value;
    setBounds(number, bounds, experiment);
  };
  setLower(lower * std::pow(reach, -kFalls));
  const Descent descent = descend(RecordingsProblem(experiment, recordings), scale, lower, reach, noise, fit);
  if (const RecordingFit& softest = descent.findSoftest(noise); softest.chi_square < fit.chi_square) {
    setLower(softest.point[scale] / reach);
    const RecordingFit free = RecordingsProblem(experiment, recordings).fit(softest.point);
    fit = free.chi_square < softest.chi_square - noise * kFlat ? free : softest;
  }
  setLower(std::min(descent.lower, fit.point[scale]));
}

}  // namespace

void followToLimit(const RecordedFeatures& recordings, Index first, const TermCandidate& candidate,
                   ExperimentSpec& experiment, RecordingFit& fit) {
  for (std::size_t i = 0; i < candidate.own_scales.size(); ++i) {
    if (candidate.own_scales[i].has_limit) {
      follow(recordings, first + 1 + static_cast<Index>(i), candidate.own_scales[i].reach, experiment, fit);
    }
  }
}

}  // namespace twinmap
