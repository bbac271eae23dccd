#include "framework/surrogate/fit_forward.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "framework/features/noise_whitener.hpp"
#include "framework/features/principal_components.hpp"
#include "framework/surrogate/feature_windows.hpp"
#include "framework/surrogate/run_tasks.hpp"
#include "kernels/surrogate/fit_slopes.hpp"

namespace twinmap {
namespace {

using Eigen::ArrayXd;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Simulations in the order in which processes take them, those with slopes first.
struct WhitenedSamples {
  MatrixXd points;       // m x n
  MatrixXd features;     // k x n, whitened
  gp::SlopeData slopes;  // of the whitened features
};

/// The first `most` simulations that have slopes, then the others.
std::vector<Index> orderBySlopes(const ForwardSamples& samples, Index& with_slopes) {
  std::vector<Index> order, others;
  Index unknown = 0;
  for (const MatrixXd& slopes : samples.slopes) {
    unknown = std::max(unknown, slopes.cols());
  }
  const Index n = samples.points.cols(), most = unknown > 0 ? countSlopePoints(n, unknown) : 0;
  for (Index i = 0; i < n; ++i) {
    const bool has =
        static_cast<Index>(order.size()) < most && samples.slopes[static_cast<std::size_t>(i)].size() > 0;
    (has ? order : others).push_back(i);
  }
  with_slopes = static_cast<Index>(order.size());
  order.insert(order.end(), others.begin(), others.end());
  return order;
}

WhitenedSamples whiten(const ForwardSamples& samples, const VectorXd& center, const NoiseWhitener& noise) {
  Index with_slopes = 0;
  const std::vector<Index> order = orderBySlopes(samples, with_slopes);
  WhitenedSamples whitened{samples.points(Eigen::all, order),
                           noise.apply(samples.clean_features(Eigen::all, order).colwise() - center),
                           {}};
  if (with_slopes == 0) {
    return whitened;
  }
  const Index unknown = samples.slopes[static_cast<std::size_t>(order[0])].cols();
  whitened.slopes.variables = unknown;
  whitened.slopes.values.resize(unknown * with_slopes, whitened.features.rows());
  for (Index i = 0; i < with_slopes; ++i) {
    const MatrixXd slopes = noise.apply(samples.slopes[static_cast<std::size_t>(order[i])]);
    for (Index v = 0; v < unknown; ++v) {
      whitened.slopes.values.row(v * with_slopes + i) = slopes.col(v).transpose();
    }
  }
  return whitened;
}

/// The scores of one window and what was fitted to them.
struct WindowFit {
  MatrixXd directions;   // k x c, of all whitened features
  MatrixXd scores;       // n x c
  gp::SlopeData slopes;  // of the scores
  gp::SharedChoice choice;
  std::optional<gp::SharedProcess> process;
};

void findScores(const FeatureWindow& rows, const WhitenedSamples& whitened, WindowFit& window) {
  constexpr double kSmallestStddev = 0.2;
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

/// From values and slopes where that predicts better: the search with all values is then not needed.
gp::SharedChoice choose(const MatrixXd& points, const WindowFit& window, gp::StopFlag stop) {
  gp::SharedChoice choice = gp::chooseOnSpread(points, window.scores, stop);
  if (window.slopes.variables > 0) {
    choice = gp::chooseWithSlopes(choice, points, window.scores, window.slopes, stop);
  }
  return choice.structure.slopes ? choice : gp::finishOnAll(choice, points, window.scores, stop);
}

gp::SharedChoice adapt(const gp::SharedChoice& similar, const MatrixXd& points, const WindowFit& window,
                       gp::StopFlag stop) {
  return similar.structure.slopes && window.slopes.variables > 0
             ? similar
             : gp::adaptSharedProcess(similar, points, window.scores, stop);
}

void fitWindow(const MatrixXd& points, const gp::SharedChoice* similar, gp::StopFlag stop,
               WindowFit& window) {
  window.choice = similar != nullptr ? adapt(*similar, points, window, stop) : choose(points, window, stop);
  if (window.choice.structure.slopes && fitWithSlopes(points, window)) {
    return;
  }
  window.choice.structure.slopes = false;
  window.process.emplace(points, window.scores, window.choice.structure, window.choice.hyperparameters);
}

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
  constexpr std::size_t kMostScores = 200;  // an inference costs their number cubed
  const double most_errors = static_cast<double>(simulations) / 4.0;
  std::vector<std::vector<Index>> chosen(windows.size());
  double errors = 0.0;
  std::size_t count = 0;
  for (const RankedScore& score : rankScores(windows)) {
    errors += score.error_share;
    if (count == kMostScores || errors > most_errors) {
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
  constexpr double kLeastShrinkage = 0.2;
  const auto n = static_cast<double>(standardised.rows());
  MatrixXd correlation = standardised.transpose() * standardised / n;
  const MatrixXd squares = standardised.array().square().matrix();
  const MatrixXd variances =
      ((squares.transpose() * squares / n).array() - correlation.array().square()).matrix() / n;
  const double of_estimates = variances.sum() - variances.trace();
  const double of_correlation = correlation.squaredNorm() - correlation.diagonal().squaredNorm();
  const double shrinkage =
      of_correlation > 0.0 ? std::clamp(of_estimates / of_correlation, kLeastShrinkage, 1.0) : 1.0;
  correlation *= 1.0 - shrinkage;
  correlation.diagonal().setOnes();
  return correlation;
}

/// Puts the chosen scores of all windows together.
void assemble(std::vector<WindowFit>& windows, const std::vector<std::vector<Index>>& chosen,
              const MatrixXd& whitener, ForwardSurrogate& surrogate) {
  Index count = 0;
  for (const auto& indices : chosen) {
    count += static_cast<Index>(indices.size());
  }
  const Index n = surrogate.points.cols();
  surrogate.projection.resize(count, whitener.cols());
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
        windows[w].directions(Eigen::all, chosen[w]).transpose() * whitener;
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

Index countSlopePoints(Index simulations, Index unknown) {
  constexpr Index kMostRows = 2000;
  return std::clamp<Index>((kMostRows - simulations) / std::max<Index>(unknown, 1), 0, simulations);
}

ForwardFit fitForward(const ForwardSamples& samples, const std::vector<gp::SharedChoice>& similar,
                      const TrainingControl& control) {
  const NoiseWhitener noise(samples.noise_covariance);
  ForwardFit fit;
  fit.surrogate.center = samples.clean_features.rowwise().mean();
  const WhitenedSamples whitened = whiten(samples, fit.surrogate.center, noise);
  fit.surrogate.points = whitened.points;
  const bool by_feature = whitened.features.rows() == static_cast<Index>(samples.infos.size());
  const std::vector<FeatureWindow> rows =
      by_feature ? makeFeatureWindows(samples.infos) : makeWindowsInOrder(whitened.features.rows());
  std::vector<WindowFit> windows(rows.size());
  runTasks(control.threads, rows.size(), [&](std::size_t w) {
    findScores(rows[w], whitened, windows[w]);
    fitWindow(whitened.points, similar.empty() ? nullptr : &similar.at(w), control.stop, windows[w]);
  });
  gp::throwIfStopped(control.stop);
  for (const WindowFit& window : windows) {
    fit.choices.push_back(window.choice);
  }
  assemble(windows, chooseScores(windows, samples.points.cols()), noise.getMatrix(), fit.surrogate);
  return fit;
}

}  // namespace twinmap
