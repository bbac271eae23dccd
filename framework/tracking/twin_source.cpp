#include "framework/tracking/twin_source.hpp"

#include <algorithm>

#include "framework/base/text/nearest_name.hpp"
#include "framework/base/text/source_location.hpp"
#include "framework/data/measurement/signal_experiment.hpp"
#include "framework/experiment/files/experiment_file.hpp"
#include "framework/experiment/trials/combine_trials.hpp"
#include "framework/experiment/trials/trial_trees.hpp"

namespace twinmap {
bool isExperimentFile(const std::filesystem::path& path) {
  return path.extension() == ".yaml" || path.extension() == ".yml";
}

TwinSource::TwinSource(const YamlNode& root) {
  for (const Trial& trial : expandTrials(root)) {
    members_.push_back(
        {trial.name, std::make_unique<InferenceSource>(readExperimentWithSignals(trial.tree))});
  }
}

TwinSource::TwinSource(const std::filesystem::path& run_or_experiment) {
  if (isExperimentFile(run_or_experiment)) {
    *this = TwinSource(loadExperimentTree(run_or_experiment.string()));
    return;
  }
  members_.push_back({"", std::make_unique<InferenceSource>(run_or_experiment)});
  requireOneTrial(members_.front().source->getExperiment(),
                  "the run infers all of them together, and a measurement is of one: give the experiment's "
                  "file");
}

std::size_t TwinSource::find(const std::string& trial) const {
  const auto found =
      std::find_if(members_.begin(), members_.end(), [&](const Member& one) { return one.trial == trial; });
  if (found != members_.end()) {
    return static_cast<std::size_t>(found - members_.begin());
  }
  if (members_.front().trial.empty()) {
    throw ExperimentError("trial: '" + trial + "': the experiment has no trials; leave it out");
  }
  std::vector<std::string> names;
  for (const Member& member : members_) {
    names.push_back(member.trial);
  }
  if (trial.empty()) {
    throw ExperimentError("a measurement is of one of the trials " + listNames(names) +
                          ": name it (--trial NAME, ?trial=NAME)");
  }
  throwUnknownTrial(trial, names);
}

std::string TwinSource::describe() const {
  std::string text;
  for (const Member& member : members_) {
    const Inferrer* trained = member.source->findTrained();
    text += member.trial + writeExperiment(member.source->getExperiment()) +
            (trained != nullptr ? trained->getMap().getKind() : "posterior");
  }
  return text;
}

}  // namespace twinmap
