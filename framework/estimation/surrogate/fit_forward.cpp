#include "framework/estimation/surrogate/fit_forward.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "framework/data/noise/noise_whitener.hpp"
#include "framework/estimation/surrogate/window_fit.hpp"

namespace twinmap {
namespace {

using Eigen::ArrayXd;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Mean variance of each score at points left out.
ArrayXd calcErrorVariance(const gp::SharedProcess& process) {
  return process.getLeftOut().amplitude.array() * process.getLeftOut().variance.mean();
}

/// A score among those of all windows.
struct RankedScore {
  std::size_t window;
  Index index;
  double rank;
  double error_share;  ///< of the variance of a measured score: that of the surrogate's error
};

/// Those that say most first.
std::vector<RankedScore> rankScores(const std::vector<WindowFit>& windows) {
  std::vector<RankedScore> ranked;
  for (std::size_t w = 0; w < windows.size(); ++w) {
    const auto count = static_cast<double>(windows[w].scores.rows());
    const ArrayXd variance = windows[w].scores.colwise().squaredNorm().transpose() / count;
    const ArrayXd error = calcErrorVariance(*windows[w].process);
    for (Index j = 0; j < error.size(); ++j) {
      ranked.push_back({w, j, variance[j] / (1.0 + error[j]), error[j] / (1.0 + error[j])});
    }
  }
  std::stable_sort(ranked.begin(), ranked.end(),
                   [](const RankedScore& a, const RankedScore& b) { return a.rank > b.rank; });
  return ranked;
}

/// The scores of each window that are kept. The errors of n simulations tell the correlations of some n / 4
/// scores; a score counts by the share of its variance that is error.
std::vector<std::vector<Index>> chooseScores(const std::vector<WindowFit>& windows, Index simulations) {
  constexpr std::size_t kMaxScores = 200;  // an inference costs their number cubed
  const double most_errors = static_cast<double>(simulations) / 4.0;
  std::vector<std::vector<Index>> chosen(windows.size());
  double errors = 0.0;
  std::size_t count = 0;
  for (const RankedScore& score : rankScores(windows)) {
    errors += score.error_share;
    if (count == kMaxScores || errors > most_errors) {
      break;
    }
    chosen[score.window].push_back(score.index);
    ++count;
  }
  for (std::vector<Index>& indices : chosen) {
    std::sort(indices.begin(), indices.end());
  }
  return chosen;
}

/// Correlation of residuals (n x r, each of unit mean square), shrunk towards the identity.
MatrixXd calcShrunkCorrelation(const MatrixXd& standardised) {
  constexpr double kMinShrinkage = 0.2;
  const auto n = static_cast<double>(standardised.rows());
  MatrixXd correlation = standardised.transpose() * standardised / n;
  const MatrixXd squares = standardised.array().square().matrix();
  const MatrixXd variances =
      ((squares.transpose() * squares / n).array() - correlation.array().square()).matrix() / n;
  const double of_estimates = variances.sum() - variances.trace();
  const double of_correlation = correlation.squaredNorm() - correlation.diagonal().squaredNorm();
  const double shrinkage =
      of_correlation > 0.0 ? std::clamp(of_estimates / of_correlation, kMinShrinkage, 1.0) : 1.0;
  correlation *= 1.0 - shrinkage;
  correlation.diagonal().setOnes();
  return correlation;
}

/// Puts the chosen scores of all windows together.
void assemble(std::vector<WindowFit>& windows, const std::vector<std::vector<Index>>& chosen,
              const NoiseWhitener& whitener, ForwardSurrogate& surrogate) {
  Index count = 0;
  for (const auto& indices : chosen) {
    count += static_cast<Index>(indices.size());
  }
  const Index n = surrogate.points.cols();
  surrogate.projection.resize(count, whitener.getScale().size());
  surrogate.scores.resize(count, n);
  surrogate.error_variance.resize(count);
  MatrixXd standardised(n, count);
  Index first = 0;
  for (std::size_t w = 0; w < windows.size(); ++w) {
    const auto size = static_cast<Index>(chosen[w].size());
    if (size == 0) {
      continue;
    }
    gp::SharedProcess& process = *windows[w].process;
    process.select(chosen[w]);
    const gp::LeftOut& left_out = process.getLeftOut();
    surrogate.projection.middleRows(first, size) =
        whitener.applyTransposed(windows[w].directions(Eigen::all, chosen[w])).transpose();
    surrogate.scores.middleRows(first, size) = windows[w].scores(Eigen::all, chosen[w]).transpose();
    surrogate.error_variance.segment(first, size) = calcErrorVariance(process);
    standardised.middleCols(first, size) =
        (left_out.residual.array() / (left_out.variance * left_out.amplitude.transpose()).array().sqrt());
    // Points where all errors are large must not decide alone how errors go together.
    constexpr double kFloor = 0.1;
    standardised.middleCols(first, size).array().colwise() /= (process.getLeftOutRatio() + kFloor).sqrt();
    surrogate.windows.push_back(std::move(process));
    first += size;
  }
  standardised.colwise().normalize();
  surrogate.error_correlation = calcShrunkCorrelation(std::sqrt(static_cast<double>(n)) * standardised);
}

}  // namespace

namespace {

std::vector<WindowChoice> chooseWindows(const ForwardSamples& samples, const WhitenedSamples& whitened,
                                        const TrainingControl& control) {
  const bool by_feature = whitened.features.rows() == static_cast<Index>(samples.infos.size());
  const std::vector<FeatureWindow> rows =
      by_feature ? makeFeatureWindows(samples.infos) : makeWindowsInOrder(whitened.features.rows());
  const std::vector<FeatureInfo> infos = by_feature ? samples.infos : std::vector<FeatureInfo>{};
  std::vector<std::vector<WindowChoice>> parts(rows.size());
  runTasks(control.threads, rows.size(),
           [&](std::size_t w) { parts[w] = divideWindow(rows[w], infos, whitened, control.stop); });
  std::vector<WindowChoice> windows;
  for (std::vector<WindowChoice>& of_window : parts) {
    std::move(of_window.begin(), of_window.end(), std::back_inserter(windows));
  }
  return windows;
}

/// Columns of the whitened samples that each fold keeps.
std::vector<WhitenedFold> makeFolds(const ForwardSamples& samples, const WhitenedSamples& whitened,
                                    const std::vector<std::vector<Index>>& folds) {
  const std::vector<Index> order = orderSimulations(samples);
  std::vector<WhitenedFold> made;
  for (const std::vector<Index>& kept : folds) {
    std::vector<Index> columns;
    for (std::size_t i = 0; i < order.size(); ++i) {
      if (std::binary_search(kept.begin(), kept.end(), order[i])) {
        columns.push_back(static_cast<Index>(i));
      }
    }
    made.push_back({columns, selectWhitened(whitened, columns)});
  }
  return made;
}

/// Windows of the whole, then of each fold.
std::vector<std::vector<WindowFit>> fitAnew(const ForwardSamples& samples, const WhitenedSamples& whitened,
                                            const std::vector<WhitenedFold>& folds,
                                            const TrainingControl& control, ForwardChoices& choices) {
  const std::vector<WindowChoice> chosen = chooseWindows(samples, whitened, control);
  std::vector<std::vector<WindowFit>> windows(1 + folds.size());
  for (std::vector<WindowFit>& of_fold : windows) {
    of_fold.resize(chosen.size());
  }
  runTasks(control.threads, chosen.size(), [&](std::size_t w) {
    WindowFits fits = fitWindow(chosen[w], whitened, folds, control.stop);
    windows[0][w] = std::move(fits.whole);
    for (std::size_t fold = 0; fold < folds.size(); ++fold) {
      windows[1 + fold][w] = std::move(fits.folds[fold]);
    }
  });
  for (const WindowChoice& window : chosen) {
    choices.windows.push_back(window.rows);
  }
  return windows;
}

std::vector<WindowFit> refit(const ForwardChoices& similar, const WhitenedSamples& whitened,
                             const TrainingControl& control) {
  std::vector<WindowFit> windows(similar.windows.size());
  runTasks(control.threads, windows.size(), [&](std::size_t w) {
    windows[w] = refitWindow(similar.windows[w], similar.processes[w], similar.slope_shares[w], whitened,
                             control.stop);
  });
  return windows;
}

}  // namespace

ForwardFit fitForward(const ForwardSamples& samples, const ForwardChoices& similar,
                      const TrainingControl& control, const std::vector<std::vector<Index>>& folds) {
  const NoiseWhitener noise(samples.noise_covariance);
  ForwardFit fit;
  fit.surrogate.center = samples.clean_features.rowwise().mean();
  const WhitenedSamples whitened = whiten(samples, fit.surrogate.center, noise);
  fit.surrogate.points = whitened.points;
  fit.choices.windows = similar.windows;
  const std::vector<WhitenedFold> parts = makeFolds(samples, whitened, folds);
  std::vector<std::vector<WindowFit>> windows;
  if (similar.windows.empty()) {
    windows = fitAnew(samples, whitened, parts, control, fit.choices);
  } else {
    windows.push_back(refit(similar, whitened, control));
  }
  gp::throwIfStopped(control.stop);
  for (const WindowFit& window : windows.front()) {
    fit.choices.processes.push_back(window.choice);
    fit.choices.slope_shares.push_back(window.slope_share);
  }
  assemble(windows.front(), chooseScores(windows.front(), samples.points.cols()), noise, fit.surrogate);
  for (std::size_t fold = 0; fold + 1 < windows.size(); ++fold) {
    const std::vector<Index>& kept = folds[fold];
    ForwardSurrogate part;
    part.center = samples.clean_features(Eigen::all, kept).rowwise().mean();
    part.points = parts[fold].samples.points;
    assemble(windows[1 + fold], chooseScores(windows[1 + fold], part.points.cols()), noise, part);
    fit.folds.push_back(std::move(part));
  }
  return fit;
}

}  // namespace twinmap
