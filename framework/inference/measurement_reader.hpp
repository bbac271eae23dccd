#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "framework/data/features/feature_extractor.hpp"
#include "framework/data/measurement/files/table.hpp"
#include "framework/data/measurement/recording/available_response.hpp"
#include "framework/data/noise/stated_noise.hpp"
#include "framework/data/reduction/response_reduction.hpp"
#include "framework/experiment/experiment_spec.hpp"
#include "framework/simulation/response_layout.hpp"
#include "framework/simulation/simulator.hpp"

namespace twinmap {

/// The features of a response (rows of the layout). Throws MeasurementError, naming `source`, where the
/// response lacks a feature, such as a third peak.
Eigen::VectorXd extractFeatures(const FeatureExtractor& extractor, const Eigen::VectorXd& response,
                                const std::string& source);

/// Features of which some may be missing.
struct AvailableFeatures {
  Eigen::VectorXd features;             ///< d, NaN where missing, the limit where clipped
  std::vector<Eigen::Index> available;  ///< the others, ascending
  std::vector<ClippedSample> clipped;   ///< features, of value `limit`
  std::vector<std::string> remarks;     ///< what is missing and why, a phrase each
  Eigen::VectorXd response;             ///< rows of the layout, NaN where missing
  StatedNoise stated{};                 ///< by the measurement

  /// Whether an estimator that was trained on all features and one noise can use them.
  bool isComplete() const {
    return static_cast<Eigen::Index>(available.size()) == features.size() && clipped.empty() &&
           !stated.isGiven();
  }
};

/// Throws MeasurementError where a measurement states standard deviations: for what uses the experiment's.
void requireNoneStated(const StatedNoise& stated, const std::string& source);

/// From tables of measurements to the features of an experiment. Immutable.
class MeasurementReader {
 public:
  explicit MeasurementReader(ExperimentSpec experiment);
  /// Of a run that reduced the samples of the experiment: experiment, layout, responses and features are then
  /// those of what they are reduced to, of which none may be missing.
  MeasurementReader(ExperimentSpec whole, std::shared_ptr<const ResponseReduction> reduction);

  const ExperimentSpec& getExperiment() const { return experiment_; }
  const ResponseLayout& getLayout() const { return layout_; }
  const FeatureExtractor& getExtractor() const { return extractor_; }

  /// Null where all samples are looked at; the simulator of the model's responses at its times.
  const ResponseReduction* findReduction() const { return reduction_.get(); }
  std::unique_ptr<Simulator> makeReducedSimulator() const;

  /// The columns that a table of a measurement must have, and those that it may have, for readTable().
  std::vector<std::string> listColumns() const;
  /// The time in a table that is the model's 0: `start`, or that of the experiment's `measurement:`
  /// (findStart).
  double getStart(const Table& table, std::optional<double> start) const;
  /// The same without a table: a trigger counts as 0.
  double getStatedStart(std::optional<double> start) const;

  /// The starts of windows every `length` s that the table covers, from getStart() on. At least one;
  /// throws MeasurementError where it covers none.
  std::vector<double> listWindows(const Table& table, std::optional<double> start, double length) const;

  /// Throws MeasurementError where the table has another excitation than the experiment
  /// (requireTrainedExcitation).
  void requireExcitation(const Table& table, std::optional<double> start) const;

  /// A measured response at the layout's times (its rows). Throws MeasurementError.
  Eigen::VectorXd readResponse(const Table& table, std::optional<double> start) const;

  /// Features of a measurement, NaN where samples that they need are missing (readAvailable); at least one is
  /// there. Throws MeasurementError.
  AvailableFeatures readAvailableFeatures(const Table& table, std::optional<double> start) const;

  /// The experiment with its features at the times of the table (followRecordedTimes), where it would be
  /// interpolated.
  std::optional<ExperimentSpec> followTimes(const Table& table, std::optional<double> start) const;

  /// How every command reads a recording: the experiment at the times of the table (followTimes). The
  /// measured excitation is that of the table or its own file, as much later as the window
  /// (followMeasuredSignals; beside: s). Modes are those beside the table (findModesFile). None where nothing
  /// changes, and of a run that reduced its samples.
  std::optional<ExperimentSpec> follow(const Table& table, std::optional<double> start,
                                       double beside = 0.0) const;

  /// Warns of outputs whose interpolation errs by more than a tenth of their noise (calcInterpolationError).
  void warnOfInterpolation(const Table& table, std::optional<double> start) const;

  /// d: requireExcitation(), readResponse() and extractFeatures().
  Eigen::VectorXd readFeatures(const Table& table, std::optional<double> start) const;

 private:
  std::optional<ExperimentSpec> followExcitation(const Table& table, std::optional<double> start,
                                                 double beside) const;
  std::optional<ExperimentSpec> followModes(const Table& table, std::optional<ExperimentSpec> followed) const;
  /// What a recording must have samples of.
  const ResponseLayout& getRecorded() const { return reduction_ ? whole_layout_ : layout_; }
  /// What samples are looked at for.
  const std::vector<FeatureSpec>& getFeatures() const {
    return reduction_ ? whole_.features : experiment_.features;
  }
  AvailableFeatures reduce(AvailableResponse response, const std::string& source) const;
  /// Of jumps by a turn, and of units that are not read.
  void warnOfColumns(const Table& table) const;
  /// A response of columns with clocks of their own, none missing.
  Eigen::VectorXd readWhole(const Table& table, double start) const;
  /// From a recording in time, or a table of modes.
  AvailableFeatures readSamples(const Table& table, std::optional<double> start) const;
  /// From a table of frequency responses, and the modes that are in another.
  AvailableFeatures readLines(const Table& table) const;

  ExperimentSpec experiment_;
  std::shared_ptr<const ResponseReduction> reduction_;
  ExperimentSpec whole_;         // of what is reduced
  ResponseLayout whole_layout_;  // likewise
  ResponseLayout layout_;
  std::optional<double> sample_interval_;
  FeatureExtractor extractor_;
  FeatureExtractor linear_;  // its linear form
};

}  // namespace twinmap
