#include "framework/estimation/surrogate/window_fit.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>
#include <utility>

#include "framework/data/reduction/principal_components.hpp"
#include "kernels/gp/sparse/inducing_points.hpp"
#include "kernels/linalg/order.hpp"
#include "kernels/surrogate/fit_slopes.hpp"
#include "kernels/surrogate/joint_precision.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

WindowFit findScores(const FeatureWindow& rows, const WhitenedSamples& whitened) {
  WindowFit window;
  const MatrixXd features = whitened.features(rows, Eigen::all);
  const PrincipalComponents components = calcPrincipalComponents(features);
  const Index count =
      std::max<Index>(1, (components.variances.array() > kSmallestStddev * kSmallestStddev).count());
  const MatrixXd kept = components.directions.leftCols(count);
  window.directions.setZero(whitened.features.rows(), count);
  window.directions(rows, Eigen::all) = kept;
  window.scores = features.transpose() * kept;
  if (whitened.slopes.variables > 0) {
    window.slopes = {whitened.slopes.values(Eigen::all, rows) * kept, whitened.slopes.variables};
  }
  return window;
}

/// Keeps the slopes at the first points alone.
void keepSlopes(Index count, WindowFit& window) {
  const Index m = window.slopes.countPoints();
  if (count >= m) {
    return;
  }
  MatrixXd kept(window.slopes.variables * count, window.slopes.values.cols());
  for (Index v = 0; v < window.slopes.variables; ++v) {
    kept.middleRows(v * count, count) = window.slopes.values.middleRows(v * m, count);
  }
  window.slopes.values = std::move(kept);
}

/// From slopes as well; false where rounding leaves their joint covariance without a Cholesky factor.
bool fitWithSlopes(const MatrixXd& points, WindowFit& window) {
  try {
    window.process.emplace(points, window.scores, window.slopes, window.choice.structure,
                           window.choice.hyperparameters);
    return true;
  } catch (const std::runtime_error&) {
    return false;
  }
}

/// Of all samples; nothing where none of the slopes are learnt from, or there is no Cholesky factor.
std::optional<gp::JointPrecision> factoriseWithSlopes(const MatrixXd& points, const WindowFit& window) {
  if (!window.choice.structure.slopes) {
    return std::nullopt;
  }
  std::optional<gp::JointPrecision> precision(std::in_place, window.choice.structure,
                                              window.choice.hyperparameters, points,
                                              window.slopes.countPoints(), window.slopes.variables);
  return precision->isDefinite() ? std::move(precision) : std::nullopt;
}

/// Fits a window of the samples kept, whose points are given.
bool fitByPrecision(const gp::JointPrecision& precision, const std::vector<Index>& kept,
                    const MatrixXd& points, WindowFit& window) {
  gp::JointFit fit;
  if (window.slopes.countPoints() == 0 || !precision.fitPoints(kept, window.scores, window.slopes, fit)) {
    return false;
  }
  window.process.emplace(points, window.slopes, std::move(fit), window.choice.structure,
                         window.choice.hyperparameters);
  return true;
}

void fitByChoice(const MatrixXd& points, gp::StopFlag stop, WindowFit& window) {
  if (window.choice.structure.slopes) {
    if (fitWithSlopes(points, window)) {
      return;
    }
    window.choice = gp::chooseSharedProcess(points, window.scores, stop);
  }
  window.process.emplace(points, window.scores, window.choice.structure, window.choice.hyperparameters);
}

double calcError(const MatrixXd& residual, const MatrixXd& directions) {
  const Eigen::ArrayXXd of_features = (residual * directions.transpose()).array();
  return 0.5 * of_features.square().log1p().mean();
}

WindowChoice chooseByValues(FeatureWindow rows, const WhitenedSamples& samples, gp::StopFlag stop) {
  const WindowFit window = findScores(rows, samples);
  WindowChoice choice{std::move(rows), gp::chooseOnSpread(samples.points, window.scores, stop)};
  const std::vector<Index> taken =
      gp::spreadIndices(samples.points.cols(), std::min(gp::kSearchPoints, samples.points.cols()));
  const MatrixXd points = samples.points(Eigen::all, taken), scores = window.scores(taken, Eigen::all);
  gp::LeftOutDensity density(points, scores, choice.by_values.structure);
  double ignored = 0.0;
  if (density.evaluate(choice.by_values.hyperparameters, ignored)) {
    choice.error = calcError(density.getLeftOut().residual, window.directions(choice.rows, Eigen::all));
  }
  return choice;
}

/// The earlier and the later half of a window's times; empty where they would be too short to be worth
/// processes of their own, or features have no time.
std::vector<FeatureWindow> halve(const FeatureWindow& rows, const std::vector<FeatureInfo>& infos) {
  constexpr std::size_t kMinTimes = 2;
  std::vector<double> times;
  for (const Index row : rows) {
    if (infos.empty() || infos[static_cast<std::size_t>(row)].output < 0) {
      return {};
    }
    times.push_back(infos[static_cast<std::size_t>(row)].time);
  }
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
  if (times.size() < 2 * kMinTimes) {
    return {};
  }
  const double middle = times[times.size() / 2];
  std::vector<FeatureWindow> halves(2);
  for (const Index row : rows) {
    halves[infos[static_cast<std::size_t>(row)].time < middle ? 0 : 1].push_back(row);
  }
  return halves;
}

std::vector<WindowChoice> divide(WindowChoice whole, const std::vector<FeatureInfo>& infos,
                                 const WhitenedSamples& samples, gp::StopFlag stop) {
  constexpr double kFew = 0.3;     // errors of about the noise: there is little to be gained
  constexpr double kGrowth = 0.5;  // errors of the later half 1.6 times those of the earlier
  const std::vector<FeatureWindow> halves =
      whole.error > kFew ? halve(whole.rows, infos) : std::vector<FeatureWindow>{};
  if (halves.empty()) {
    return {std::move(whole)};
  }
  WindowChoice early = chooseByValues(halves[0], samples, stop);
  WindowChoice late = chooseByValues(halves[1], samples, stop);
  if (late.error < early.error + kGrowth) {
    return {std::move(whole)};
  }
  std::vector<WindowChoice> parts = divide(std::move(early), infos, samples, stop);
  for (WindowChoice& part : divide(std::move(late), infos, samples, stop)) {
    parts.push_back(std::move(part));
  }
  return parts;
}

Index countBelow(const std::vector<Index>& rising, Index limit) {
  return std::distance(rising.begin(), std::lower_bound(rising.begin(), rising.end(), limit));
}

/// Fits the process; gives the precision that it is of, if `by_precision` and there is one.
std::optional<gp::JointPrecision> fitOnce(const MatrixXd& points, bool by_precision, gp::StopFlag stop,
                                          WindowFit& window) {
  std::optional<gp::JointPrecision> precision =
      by_precision ? factoriseWithSlopes(points, window) : std::nullopt;
  if (!precision || !fitByPrecision(*precision, listIndices(points.cols()), points, window)) {
    fitByChoice(points, stop, window);
  }
  return precision;
}

/// Of the score that is predicted worst, at points left out, in units of the noise's variance.
double calcLargestErrorVariance(const gp::SharedProcess& process) {
  return process.getLeftOut().amplitude.maxCoeff() * process.getLeftOut().variance.mean();
}

/// From few slopes, then from more as long as that leaves errors that matter.
std::optional<gp::JointPrecision> fitWhole(const MatrixXd& points, bool by_precision, gp::StopFlag stop,
                                           WindowFit& window) {
  // Without any error at all, standard deviations would be smaller by half of it at most.
  constexpr double kNegligible = 0.02;
  const Index all = window.slopes.countPoints();
  if (window.choice.structure.slopes) {
    for (const Index few : listFewSlopePoints(points.cols(), window.slopes.variables, all)) {
      WindowFit of_few = window;
      keepSlopes(few, of_few);
      of_few.slope_share = static_cast<double>(few) / static_cast<double>(all);
      std::optional<gp::JointPrecision> precision = fitOnce(points, by_precision, stop, of_few);
      if (of_few.choice.structure.slopes && calcLargestErrorVariance(*of_few.process) < kNegligible) {
        window = std::move(of_few);
        return precision;
      }
    }
  }
  return fitOnce(points, by_precision, stop, window);
}

}  // namespace

std::vector<WindowChoice> divideWindow(const FeatureWindow& rows, const std::vector<FeatureInfo>& infos,
                                       const WhitenedSamples& samples, gp::StopFlag stop) {
  return divide(chooseByValues(rows, samples, stop), infos, samples, stop);
}

WindowFits fitWindow(const WindowChoice& chosen, const WhitenedSamples& samples,
                     const std::vector<WhitenedFold>& folds, gp::StopFlag stop) {
  WindowFits fits{findScores(chosen.rows, samples), {}};
  WindowFit& window = fits.whole;
  window.choice = chosen.by_values;
  if (window.slopes.variables > 0) {
    window.choice =
        gp::chooseWithSlopes(chosen.by_values, samples.points, window.scores, window.slopes, stop);
  }
  if (!window.choice.structure.slopes) {
    window.choice = gp::finishOnAll(window.choice, samples.points, window.scores, stop);
  }
  const std::optional<gp::JointPrecision> precision = fitWhole(samples.points, !folds.empty(), stop, window);
  for (const WhitenedFold& fold : folds) {
    WindowFit part = findScores(chosen.rows, fold.samples);
    part.choice = window.choice;
    part.slope_share = window.slope_share;
    keepSlopes(countBelow(fold.kept, window.slopes.countPoints()), part);
    if (!precision || !fitByPrecision(*precision, fold.kept, fold.samples.points, part)) {
      part = refitWindow(chosen.rows, window.choice, window.slope_share, fold.samples, stop);
    }
    fits.folds.push_back(std::move(part));
  }
  return fits;
}

WindowFit refitWindow(const FeatureWindow& rows, const gp::SharedChoice& similar, double slope_share,
                      const WhitenedSamples& samples, gp::StopFlag stop) {
  WindowFit window = findScores(rows, samples);
  window.slope_share = slope_share;
  keepSlopes(std::lround(slope_share * static_cast<double>(window.slopes.countPoints())), window);
  window.choice = similar.structure.slopes && window.slopes.variables > 0
                      ? similar
                      : gp::adaptSharedProcess(similar, samples.points, window.scores, stop);
  fitByChoice(samples.points, stop, window);
  return window;
}

}  // namespace twinmap
