#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "framework/estimation/surrogate/feature_windows.hpp"
#include "framework/estimation/surrogate/forward_samples.hpp"
#include "kernels/surrogate/fit_shared_process.hpp"
#include "kernels/surrogate/shared_process.hpp"

namespace twinmap {

/// The scores of one window and what was fitted to them.
struct WindowFit {
  Eigen::MatrixXd directions;  ///< k x c, of all whitened features
  Eigen::MatrixXd scores;      ///< n x c
  gp::SlopeData slopes;        ///< of the scores
  double slope_share = 1.0;    ///< of the slopes known, those that are learnt from
  gp::SharedChoice choice;
  std::optional<gp::SharedProcess> process;
};

/// A window and what was chosen for its values alone, on at most 300 points.
struct WindowChoice {
  FeatureWindow rows;
  gp::SharedChoice by_values;
  double error = 0.0;  ///< nats: mean over its features and points left out of log(1 + error^2) / 2
};

/// Parts a window of samples in halves of its time, and those again, where the errors of the later half are
/// above those of the earlier by 0.5 nats: there a response begins to be unpredictable, and the earlier part
/// is learnt far better with length scales of its own, from slopes above all. `infos` are of the whitened
/// features; where they are none, nothing is parted. Cost: a search (gp::chooseOnSpread) for each window
/// tried.
std::vector<WindowChoice> divideWindow(const FeatureWindow& rows, const std::vector<FeatureInfo>& infos,
                                       const WhitenedSamples& samples, gp::StopFlag stop);

/// Samples of a fold of a cross-validation.
struct WhitenedFold {
  std::vector<Eigen::Index> kept;  ///< of the whole's whitened samples, rising
  WhitenedSamples samples;
};

/// A window of all samples and, by the same choice, of each fold.
struct WindowFits {
  WindowFit whole;
  std::vector<WindowFit> folds;
};

/// Fits a window anew, from values and slopes where that predicts better; then the folds, which share the
/// factorisation of a joint covariance with slopes (gp::JointPrecision). Of the slopes few are taken
/// (listFewSlopePoints) where the variances of the errors at points left out are below a fiftieth of the
/// noise's already.
WindowFits fitWindow(const WindowChoice& window, const WhitenedSamples& samples,
                     const std::vector<WhitenedFold>& folds, gp::StopFlag stop);

/// Fits a window by a choice made on nearly the same samples, from that share of their slopes.
WindowFit refitWindow(const FeatureWindow& rows, const gp::SharedChoice& similar, double slope_share,
                      const WhitenedSamples& samples, gp::StopFlag stop);

}  // namespace twinmap
