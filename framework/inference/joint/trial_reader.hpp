#pragma once

#include <optional>
#include <string>
#include <vector>

#include "framework/inference/joint/recording_list.hpp"

namespace twinmap {

/// A file, and the trial that it records.
struct TrialFile {
  std::string trial, file;
};

/// Of each "NAME=FILE" that --trial gives. Throws ExperimentError for another text.
std::vector<TrialFile> parseTrialFiles(const std::vector<std::string>& texts);

/// From recordings of trials to the features of an experiment that combines them (combineTrials). Immutable.
class TrialReader {
 public:
  explicit TrialReader(const ExperimentSpec& combined);

  /// Of one trial. Throws ExperimentError for an unknown one.
  const MeasurementReader& get(const std::string& trial) const;

  /// The features (d) of all trials; none where a trial has no recording or several, or a recording lacks
  /// samples or states its noise. Throws MeasurementError where a recording cannot be used.
  /// start: the time in each that is 0 of the model; none: as the trial says.
  std::optional<Eigen::VectorXd> read(const std::vector<RecordedTable>& recordings,
                                      std::optional<double> start = {}) const;

 private:
  struct Trial {
    std::string name;
    MeasurementReader reader;
  };

  std::vector<Trial> trials_;
};

}  // namespace twinmap
