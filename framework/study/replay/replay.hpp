#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "framework/inference/measurement/inference_source.hpp"

namespace twinmap {

/// A stretch of a file of measurements.
struct MeasuredWindow {
  std::filesystem::path file;
  double start = 0.0;  ///< time in the file (s) that is 0 of the model
};

inline bool operator==(const MeasuredWindow& a, const MeasuredWindow& b) {
  return a.file == b.file && a.start == b.start;
}

struct ReplayOptions {
  MeasuredWindow measurement;       ///< what is simulated again
  MeasuredWindow from;              ///< what the parameters are inferred from
  Eigen::VectorXd known;            ///< inputs of the set-up (q), the same in both
  std::optional<bool> refine = {};  ///< the inference, on the simulator; none: as the experiment says
  int draws = 50;                   ///< of the ensemble, at least 2
  int threads = 0;                  ///< 0: as many as OpenMP offers
};

/// How well a model follows a measured output.
struct OutputFit {
  double nrmse_pct = 0.0;   ///< 100 rms(measured - model) / rms(measured - its mean)
  double rms_sd = 0.0;      ///< rms of the residual in standard deviations of the noise
  double largest_sd = 0.0;  ///< largest residual in the same
};

/// A model in the place of the machine.
struct ReplayedModel {
  Eigen::VectorXd point;           ///< of the sampled box; nuisance parameters as fitted to the measurement
  bool nuisance_converged = true;  ///< the search for those
  Eigen::VectorXd response;        ///< rows of the layout
  std::vector<OutputFit> fits;     ///< of each output
};

/// Models next to a measurement.
struct Replay {
  ReplayOptions options;
  ExperimentSpec experiment;     ///< with the excitation of the measurement
  InferredMeasurement inferred;  ///< from options.from
  ResponseLayout layout;
  Eigen::VectorXd measured, noise_stddev;  ///< rows of the layout; measured: NaN where missing
  ReplayedModel nominal, updated;          ///< at the centre of the box, and at what was inferred
  Eigen::VectorXd lower, upper;            ///< 2.5 % and 97.5 % quantiles of the ensemble, rows of the layout
};

/// Infers the updating parameters from one window and simulates the model at the times of another, with the
/// excitation that was measured there, if the excitation is measured. The nuisance parameters of that window
/// (its initial state, its offset) are fitted to it, for the nominal and for the updated model alike; the
/// updating parameters are held. The ensemble: `draws` of the updating parameters from the normal
/// distribution of covariance D R D (GpMap), or of that of an accepted refinement, or from a posterior, the
/// nuisance parameters held at those of the updated model. Points are moved into the box. The result does
/// not depend on `threads`. Throws MeasurementError for a file that cannot be used, std::runtime_error for a
/// simulation that fails. A refinement that is not accepted leaves the estimator's. Cost: draws + 2
/// simulations, and those of the searches (refine).
///
/// By an experiment alone: at the times of the recording, whose missing samples are NaN; where some are, or
/// the noise is unknown, the updated model is the best fit.
Replay replay(const InferenceSource& source, const ReplayOptions& options);

/// The same of what was inferred from a table already, at options.measurement = options.from.
Replay replayInferred(const InferenceSource& source, const Table& table, const InferredMeasurement& inferred,
                      const ReplayOptions& options);

/// The fits of each output of a response (rows of the layout) to the samples that are there (not NaN).
std::vector<OutputFit> calcFits(const Eigen::VectorXd& measured, const Eigen::VectorXd& response,
                                const Eigen::VectorXd& noise_stddev, const ResponseLayout& layout);

}  // namespace twinmap
