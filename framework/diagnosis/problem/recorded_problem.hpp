#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "framework/inference/joint/joint_inference.hpp"
#include "framework/inference/joint/trial_reader.hpp"
#include "framework/inference/known_value.hpp"
#include "framework/inference/refiner.hpp"

namespace twinmap {

/// What recordings of one trial have in common.
struct TrialSetup {
  ResponseLayout layout;
  Eigen::VectorXd known;  ///< of the inputs
};

/// What a recording has in the place of its experiment's (MeasurementReader::follow), and what it states of
/// its noise or its excitation's has in common (supposeInput).
struct OwnSetup {
  std::vector<SignalSpec> excitation;
  std::vector<FeatureSpec> features;
  ResponseLayout layout;  ///< of these features
  StatedNoise stated{};
};

/// Recordings of one machine, as features of an experiment, or of the trials that it combines.
struct RecordedFeatures {
  ResponseLayout layout;
  std::vector<Eigen::VectorXd> features;  ///< of each recording, NaN where missing
  Eigen::VectorXd known;                  ///< of the inputs
  /// Of each recording; null where all is as the experiment says. Empty where it is for all.
  std::vector<std::shared_ptr<const OwnSetup>> own{};
  std::vector<std::string> labels{};  ///< of each recording; empty: their numbers, "[2]"
  /// Of each recording, where its sensors have faults (takeFaults); empty where that is known of none.
  std::vector<NoiseHypothesis> noise{};
  std::vector<TrialSetup> setups{};   ///< of the experiment's trials in the place of layout and known
  std::vector<std::size_t> trials{};  ///< of each recording, the number of its trial; empty without trials

  std::size_t getTrial(std::size_t recording) const { return trials.empty() ? 0 : trials[recording]; }
  NoiseHypothesis getNoise(std::size_t recording) const {
    return noise.empty() ? NoiseHypothesis() : noise[recording];
  }
  bool hasFaults() const;
  const OwnSetup* findOwn(std::size_t recording) const {
    return own.empty() ? nullptr : own[recording].get();
  }
  const ResponseLayout& getLayout(std::size_t recording) const;
  const Eigen::VectorXd& getKnown(std::size_t recording) const {
    return trials.empty() ? known : setups[trials[recording]].known;
  }
  /// The experiment of a recording's trial, with what is its own.
  ExperimentSpec makeExperiment(const ExperimentSpec& experiment, std::size_t recording) const;
  /// The outputs of one recording after the other, by trial ("free.x") where there are trials.
  std::vector<std::string> listOutputs(const ExperimentSpec& experiment) const;

  RecordedFeatures select(const std::vector<std::size_t>& recordings) const;
  /// All but one.
  RecordedFeatures leaveOut(std::size_t recording) const;
};

/// The recordings behind those that are there.
void append(const RecordedFeatures& more, RecordedFeatures& recordings);

/// One window of a table, as inference reads it: at its own times, with its own excitation
/// (MeasurementReader::follow), of which what is not known is supposed (supposeInput). Samples at a limit of
/// their sensor are left out. start: time in it that is 0 of the model; none: as the experiment says.
/// Throws MeasurementError.
RecordedFeatures readRecording(const MeasurementReader& reader, const Table& table,
                               std::optional<double> start, const Eigen::VectorXd& known);

/// All windows of some files, which start at `starts` in each; without them where the experiment says.
/// known: values of the inputs. Throws MeasurementError, ExperimentError.
RecordedFeatures readRecordings(const MeasurementReader& reader, const std::vector<std::string>& files,
                                const std::vector<double>& starts, const std::vector<KnownValue>& known);

/// What was inferred jointly, as inference reads it. combined: its trials, if it has any. Throws as above.
RecordedFeatures readRecordings(const ExperimentSpec& combined, const std::vector<Recording>& recordings,
                                const std::vector<KnownValue>& known);

/// Nothing measured, of each trial or of the only one.
RecordedFeatures makeEmptyRecordings(const ExperimentSpec& experiment, const std::vector<KnownValue>& known);

/// One of the recordings, and its own unknown parameters.
struct SingleRecording {
  ExperimentSpec experiment;  ///< that of its trial
  RecordedFeatures recording;
  Eigen::VectorXd point;  ///< the machine's parameters, then its nuisance parameters
};

/// Number k of the recordings. point: of all unknown parameters (RecordingsProblem).
SingleRecording takeRecording(const ExperimentSpec& experiment, const RecordedFeatures& recordings,
                              const Eigen::VectorXd& point, std::size_t k);

/// A linear model of all recordings at a point: residual(at + step) ~ residual - jacobian step.
struct LinearizedRecordings {
  Eigen::VectorXd residual;          ///< n, in noise standard deviations, without the faults of sensors
  Eigen::MatrixXd jacobian;          ///< n x u, per unit of the parameters
  std::vector<Eigen::Index> starts;  ///< first residual of each sequence of neighbours in time, ascending
};

/// Columns of derivatives, or parameters, by number: all but `count` from `first` on.
std::vector<Eigen::Index> listOthers(Eigen::Index all, Eigen::Index first, Eigen::Index count);

/// A point where a misfit is least, and the misfit there.
struct RecordingFit {
  Eigen::VectorXd point;  ///< u, in the parameters' units; empty where nothing could be simulated
  double chi_square = 0.0;
};

/// An experiment that is to explain recordings: the parameters are those of the machine, then those that each
/// recording leaves unknown besides. For one thread.
class RecordingsProblem {
 public:
  /// `recordings` must outlive the object. Throws ExperimentError where a feature has no noise.
  RecordingsProblem(const ExperimentSpec& experiment, const RecordedFeatures& recordings);
  RecordingsProblem(const RecordingsProblem&) = delete;
  RecordingsProblem& operator=(const RecordingsProblem&) = delete;

  const std::vector<ParameterSpec>& getUnknown() const { return problem_.unknown; }
  const PosteriorProblem& get() const { return problem_; }
  const SimulatorRefiner& getSimulator() const { return *simulators_.front(); }

  /// Of all residuals, for testResidual(): each recording's outputs have numbers of their own.
  std::vector<FeatureInfo> listInfos() const;

  /// Throws std::runtime_error where the point cannot be simulated. Cost: one simulation with derivatives a
  /// recording.
  LinearizedRecordings linearize(const Eigen::VectorXd& point) const;

  /// Searches side by side from points (u x n), the best of which is kept. held: a parameter that stays.
  RecordingFit fit(const Eigen::MatrixXd& starts, Eigen::Index held = -1) const;

 private:
  std::vector<std::unique_ptr<const SimulatorRefiner>> simulators_;  // of trials, and recordings of their own
  std::vector<std::size_t> outputs_;                                 // of each recording, how many
  std::vector<NoiseHypothesis> faults_;                              // of each recording's sensors
  PosteriorProblem problem_;
};

/// A point of an experiment's unknown parameters with `added` (k) behind the first p, where addAll() and
/// addTerm() put theirs.
Eigen::VectorXd insertAdded(const Eigen::VectorXd& point, Eigen::Index p, const Eigen::VectorXd& added);

}  // namespace twinmap
