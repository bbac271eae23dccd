#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "framework/inference/inferrer.hpp"
#include "framework/inference/measurement/measurement_session.hpp"

namespace twinmap {

/// What measurements are inferred by: a trained run, or an experiment alone. Immutable, for any number of
/// threads, each with a session of its own.
class InferenceSource {
 public:
  /// The folder of a run, its maps.h5, or an experiment file (.yaml, .yml). Throws std::runtime_error for a
  /// file that is missing or was made by another version, ExperimentError for an experiment that is wrong.
  explicit InferenceSource(const std::filesystem::path& run_or_experiment);
  explicit InferenceSource(ExperimentSpec experiment);

  /// Null where nothing was trained.
  const Inferrer* findTrained() const { return trained_ ? &*trained_ : nullptr; }
  const MeasurementReader& getReader() const { return trained_ ? trained_->getReader() : *reader_; }
  const ExperimentSpec& getExperiment() const { return getReader().getExperiment(); }

  /// The source must outlive the session. Throws ExperimentError as MeasurementSession and DirectInference
  /// do, and for an experiment alone where refining or the surrogate's posterior is asked for.
  std::unique_ptr<MeasurementInference> makeSession(const SessionOptions& options) const;

 private:
  std::optional<Inferrer> trained_;
  std::optional<MeasurementReader> reader_;  // of an experiment alone
};

/// Of an experiment file by itself. Of one with trials all of them, whichever `trial` chooses.
InferenceSource readAllTrials(const std::filesystem::path& experiment);

}  // namespace twinmap
