#pragma once

#include <memory>
#include <optional>

#include "framework/inference/inferrer.hpp"
#include "framework/inference/measurement_reader.hpp"
#include "framework/inference/refiner.hpp"

namespace twinmap {

/// What reads a recording, and what simulates it; of its own times and excitation where it has them.
struct RecordingSetup {
  std::shared_ptr<const MeasurementReader> reader;
  std::shared_ptr<const SimulatorRefiner> simulator;  ///< for one thread, which OpenMP's others help
};

/// What simulates what a reader of times or an excitation of its own reads.
RecordingSetup makeSetup(std::shared_ptr<const MeasurementReader> reader);

/// A recording, or a window of one, before it is explained.
struct UnexplainedRecording {
  std::shared_ptr<const MeasurementReader> reader;  ///< of its own times and excitation where it has them
  AvailableFeatures found;
};

/// Throws MeasurementError where the table cannot be used.
UnexplainedRecording readUnexplained(std::shared_ptr<const MeasurementReader> reader, const Table& table,
                                     std::optional<double> start);

/// What of a table explainRecording() looks at. Throws MeasurementError.
AvailableFeatures readFeatures(const MeasurementReader& reader, const Table& table,
                               std::optional<double> start);

/// A recording, or a window of one, with the faults of its sensors and the nuisance that explain it.
struct ExplainedRecording {
  RecordingSetup setup;          ///< of which the nuisance has sizes behind the model's unknown
  AvailableFeatures found;       ///< without its spikes
  Eigen::VectorXd known;         ///< of the inputs
  NoiseHypothesis noise;         ///< with the faults of its sensors
  SimulatorPosterior posterior;  ///< of all that the simulator leaves unknown
  InferredMeasurement inferred;  ///< the same, as it is reported

  /// As a part of a problem; the setup must outlive it.
  MeasuredTrial makeTrial() const;
};

/// The posterior of a recording by simulation alone, under the stated noise. Where that does not explain it,
/// others are tried one after the other:
///   without its spikes (findSpikedFeatures), if that explains it or leaves less than half of the misfit
///   other hypotheses of the noise (SimulatorSampler::samplePosterior)
///   without what every other sample is off by (findAlternation)
///   a nuisance of its own, as a clock with faults (NuisanceSearch)
/// Else the simple fault that explains a gross misfit, and what speaks against the model, are named. What is
/// unknown of the excitation is supposed (makeOwnSimulator). found: readFeatures() of the table. lead:
/// the machine's parameters, to search from as well.
ExplainedRecording explainRecording(const RecordingSetup& setup, AvailableFeatures found, const Table& table,
                                    std::optional<double> start, const Eigen::VectorXd& known,
                                    const SimulatorPosteriorOptions& options,
                                    const Eigen::VectorXd& lead = {});

/// Remarks noise of an excitation that was not stated and may be what is left (describeUnstatedNoise).
void nameUnstatedNoise(ExplainedRecording& explained);

/// Whether a nuisance of the recording explains a model_mismatch (NuisanceSearch); then it is what was
/// inferred, whose posterior is the simulator's.
bool tryNuisance(const SimulatorPosteriorOptions& options, ExplainedRecording& explained);

}  // namespace twinmap
