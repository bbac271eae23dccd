#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "framework/experiment/experiment_spec.hpp"
#include "framework/simulation/response_layout.hpp"

namespace twinmap {

/// Scores of a window at most.
inline constexpr Eigen::Index kMostScores = 24;

/// The samples of all outputs within a span of time, and what is kept of them.
struct ReductionWindow {
  std::vector<Eigen::Index> rows;  ///< of the response, rising: output by output
  /// rows x l, orthonormal; of single precision, for they are most of what a trained map takes, and any
  /// directions would do as long as all use the same.
  Eigen::MatrixXf directions;
  double rest_scale = 1.0, colour_scale = 1.0;  ///< standard deviations of the two sums, with noise
  double colour_share = 0.0;  ///< c below, with which noise alone makes the sums independent

  double countDegrees() const { return static_cast<double>(directions.rows() - directions.cols()); }
};

/// Of a window with rows and directions: sets colour_share, and both standard deviations, exactly where all
/// is noise, with what a clean response leaves beside the directions on average, `left` (its square).
void setScales(double left, ReductionWindow& window);

/// What a long response is reduced to. Samples in units of their noise, from those at the centre of the
/// bounds on, z, become in each window
///   scores = Q' z,   rest = |r|^2 / a,   colour = (sum r_i r_(i+1) - c |r|^2) / b,   r = z - Q scores,
/// with independent noise of unit variance, that of the two sums normal as nearly as a window is long. Scores
/// are functions of the parameters whatever the directions Q are, so that these lose information, and bias
/// nothing; the two sums show a misfit, or noise of another size or colour, that the directions do not see.
/// Immutable.
struct ResponseReduction {
  ResponseLayout layout;           ///< outputs score_1 ... score_l, rest, colour at a time of each window
  Eigen::VectorXd center;          ///< a clean response
  Eigen::VectorXd inverse_stddev;  ///< of each row of a response; 0 of those that no feature reads
  std::vector<ReductionWindow> windows;
  /// p: standard deviations that the scores allow over those of all samples, over the bounds.
  Eigen::VectorXd stddev_ratio;

  Eigen::Index countScores() const { return windows.front().directions.cols(); }  ///< l, of a window
  Eigen::Index countSamples() const;

  /// Of a clean response (rows).
  Eigen::VectorXd reduce(const Eigen::Ref<const Eigen::VectorXd>& response) const;
  /// Of a measured one: what noise alone adds to the rest is taken off.
  Eigen::VectorXd reduceMeasured(const Eigen::VectorXd& response) const;
  /// Derivatives (rows x p) of a clean response to those of what it is reduced to.
  Eigen::MatrixXd reduceDerivatives(const Eigen::Ref<const Eigen::VectorXd>& response,
                                    const Eigen::Ref<const Eigen::MatrixXd>& derivatives) const;

  /// Of all its numbers: two reductions that differ make other responses.
  std::uint64_t calcDigest() const;
  /// "1000000 samples to 512 x 10 scores; ..." for the log and the report.
  std::string describe(const std::vector<ParameterSpec>& parameters) const;
};

/// Whether the samples of an experiment are to be reduced (features.samples.reduce).
bool isReduced(const ExperimentSpec& experiment);

/// With 'reduce: automatic' where the samples are 10000 or more, nothing else is looked at and their noise is
/// independent, unless the file says otherwise, has trials or another program simulates.
ExperimentSpec reduceLongRecord(const ExperimentSpec& experiment);

/// Throws ExperimentError where they are: for `what`, which needs all samples.
void requireAllSamples(const ExperimentSpec& experiment, const std::string& what);

/// What is reduced, seen as an experiment: its features are the samples of the layout's outputs, each with
/// unit noise. The model is as it was.
ExperimentSpec reduceExperiment(ExperimentSpec experiment, const ResponseReduction& reduction);

/// Into how many windows so many samples are parted.
inline double countReducedWindows(double samples) {
  constexpr double kMostWindows = 512.0, kFewestSamples = 128.0;
  return std::clamp(std::floor(samples / kFewestSamples), 1.0, kMostWindows);
}

/// The samples that features read, parted into windows of equally many times: up to 512 of at least 128
/// samples. Without directions.
std::vector<ReductionWindow> partResponse(const ExperimentSpec& experiment, const ResponseLayout& layout);

/// The layout of what `windows` windows of l scores become, within `duration` s.
ResponseLayout makeReducedLayout(Eigen::Index windows, Eigen::Index scores, double duration);

}  // namespace twinmap
