#include "framework/inference/joint/trial_reader.hpp"

#include <algorithm>

#include "framework/base/text/source_location.hpp"
#include "framework/experiment/trials/combine_trials.hpp"

namespace twinmap {

std::vector<TrialFile> parseTrialFiles(const std::vector<std::string>& texts) {
  std::vector<TrialFile> files;
  for (const std::string& text : texts) {
    const std::size_t equals = text.find('=');
    if (equals == 0 || equals == std::string::npos || equals + 1 == text.size()) {
      throw ExperimentError("--trial " + text + ": must be NAME=FILE, the name of a trial and its recording");
    }
    files.push_back({text.substr(0, equals), text.substr(equals + 1)});
  }
  return files;
}

TrialReader::TrialReader(const ExperimentSpec& combined) {
  for (const TrialExperiment& trial : combined.trials) {
    trials_.push_back({trial.name, MeasurementReader(trial.experiment)});
  }
}

const MeasurementReader& TrialReader::get(const std::string& trial) const {
  const auto found =
      std::find_if(trials_.begin(), trials_.end(), [&](const Trial& one) { return one.name == trial; });
  if (found == trials_.end()) {
    std::vector<std::string> names;
    for (const Trial& one : trials_) {
      names.push_back(one.name);
    }
    throwUnknownTrial(trial, names);
  }
  return found->reader;
}

std::optional<Eigen::VectorXd> TrialReader::read(const std::vector<RecordedTable>& recordings,
                                                 std::optional<double> start) const {
  std::vector<double> features;
  for (const Trial& trial : trials_) {
    const auto is_of_trial = [&](const RecordedTable& one) { return one.trial == trial.name; };
    if (std::count_if(recordings.begin(), recordings.end(), is_of_trial) != 1) {
      return {};
    }
    const Table& table = std::find_if(recordings.begin(), recordings.end(), is_of_trial)->table;
    if (trial.reader.followTimes(table, start)) {
      return {};
    }
    const AvailableFeatures found = trial.reader.readAvailableFeatures(table, start);
    if (!found.isComplete()) {
      return {};
    }
    features.insert(features.end(), found.features.begin(), found.features.end());
  }
  return Eigen::Map<Eigen::VectorXd>(features.data(), static_cast<Eigen::Index>(features.size()));
}

}  // namespace twinmap
