#include "framework/experiment/files/experiment_file.hpp"

#include <algorithm>

#include "framework/experiment/check/check_experiment.hpp"
#include "framework/experiment/check/check_features.hpp"
#include "framework/experiment/files/prior_files.hpp"
#include "framework/experiment/files/resolve_defaults.hpp"
#include "framework/experiment/files/signal_files.hpp"
#include "framework/experiment/files/tracking_file.hpp"
#include "framework/experiment/model/elements/force_elements.hpp"
#include "framework/experiment/tree/overrides.hpp"
#include "framework/experiment/tree/read_value.hpp"
#include "framework/experiment/tree/swept_keys.hpp"
#include "framework/experiment/tree/write_value.hpp"
#include "framework/experiment/trials/combine_trials.hpp"
#include "framework/experiment/trials/trial_trees.hpp"

namespace twinmap {
namespace {

constexpr const char* kSweep = "sweep";

/// With the overrides applied, and names of files relative to the folder of `path` made absolute.
YamlNode finishTree(YamlNode root, const std::string& path, const std::vector<std::string>& overrides) {
  for (const std::string& text : overrides) {
    applyOverride(root, text);
  }
  resolveSignalFiles(root, path);
  resolvePriorFiles(root, path);
  return root;
}

YamlNode withoutKey(YamlNode root, const char* key) {
  root.entries.erase(std::remove_if(root.entries.begin(), root.entries.end(),
                                    [&](const YamlEntry& entry) { return entry.key == key; }),
                     root.entries.end());
  return root;
}

/// As its tree says, without defaults that depend on other values.
ExperimentSpec readPlain(const YamlNode& tree) {
  ExperimentSpec experiment;
  readValue(withoutKey(withoutSweep(tree), kTrackingKey), experiment);
  requireFewSamples(experiment.features, experiment.name.where);
  return experiment;
}

/// The features of all trials go through one transform.
void requireSameTransform(const ExperimentSpec& base, const ExperimentSpec& trial, const std::string& name) {
  if (writeYaml(writeValue(base.transform)) != writeYaml(writeValue(trial.transform))) {
    throw ExperimentError(trial.name.where, name,
                          "has a transform of its own, but the features of all trials go through one; give "
                          "it beside 'trials', or choose one trial");
  }
}

/// resolve: whether defaults are to be found, or have been.
ExperimentSpec readCombined(const std::vector<Trial>& trees, bool resolve) {
  ExperimentSpec base = readPlain(trees.front().tree);
  std::vector<TrialExperiment> trials;
  for (const Trial& tree : trees) {
    trials.push_back({tree.name, readPlain(tree.tree)});
    ExperimentSpec& trial = trials.back().experiment;
    requireSameTransform(base, trial, tree.name);
    trial.design.sensors.reset();  // of the outputs and signals of all
    trial.design.excitation.reset();
    if (resolve) {
      resolveDefaults(trial);
    }
  }
  ExperimentSpec combined = combineTrials(std::move(base), std::move(trials));
  if (resolve) {
    resolveDefaults(combined);
  }
  return combined;
}

/// With its defaults resolved; all trials where none is chosen.
ExperimentSpec readUnchecked(const YamlNode& root) {
  const YamlNode tree = selectTrial(root);
  if (hasTrials(tree)) {
    return readCombined(expandTrials(tree), true);
  }
  ExperimentSpec experiment = readPlain(tree);
  resolveDefaults(experiment);
  return experiment;
}

/// The tree of an experiment that combines trials, from those of each.
YamlNode writeCombined(const ExperimentSpec& experiment) {
  std::vector<Trial> trees;
  for (const TrialExperiment& trial : experiment.trials) {
    ExperimentSpec own = trial.experiment;
    own.noise.replicates = experiment.noise.replicates;
    trees.push_back({trial.name, writeValue(own)});
  }
  return joinTrials(writeValue(experiment), trees);
}

}  // namespace

ExperimentSpec readExperiment(const YamlNode& root) {
  const ExperimentSpec experiment = readUnchecked(root);
  for (const TrialExperiment& trial : experiment.trials) {
    checkExperiment(trial.experiment);
  }
  experiment.trials.empty() ? checkExperiment(experiment) : checkBesideModel(experiment);
  return experiment;
}

ExperimentSpec readExperimentOfCheckedModel(const YamlNode& root) {
  const ExperimentSpec experiment = readUnchecked(root);
  for (const TrialExperiment& trial : experiment.trials) {
    checkBesideModel(trial.experiment);
  }
  checkBesideModel(experiment);
  return experiment;
}

YamlNode loadExperimentTree(const std::string& path, const std::vector<std::string>& overrides) {
  return finishTree(loadYaml(path), path, overrides);
}

YamlNode parseExperimentTree(const std::string& text, const std::string& source,
                             const std::vector<std::string>& overrides) {
  return finishTree(parseYaml(text, source), source, overrides);
}

ExperimentSpec loadExperiment(const std::string& path, const std::vector<std::string>& overrides) {
  return readExperiment(loadExperimentTree(path, overrides));
}

std::string writeExperiment(const ExperimentSpec& experiment) {
  return writeYaml(experiment.trials.empty() ? writeValue(experiment) : writeCombined(experiment));
}

ExperimentSpec readResolved(const std::string& text) {
  const YamlNode tree = parseYaml(text, "resolved.yaml");
  if (hasTrials(tree)) {
    return readCombined(expandTrials(tree), false);
  }
  ExperimentSpec experiment;
  readValue(tree, experiment);
  return experiment;
}

std::string writeIndependentDefaults(const YamlNode& root) {
  if (root.find("trials") != nullptr) {
    return writeYaml(root);  // each trial has defaults of its own
  }
  ExperimentSpec experiment;
  readValue(withoutKey(withoutSweep(root), kTrackingKey), experiment);
  YamlNode tree = writeValue(experiment);
  if (const std::optional<SweepSpec> sweep = readSweep(root)) {
    tree.entries.push_back({kSweep, {}, writeValue(*sweep)});
  }
  return writeYaml(tree);
}

std::optional<SweepSpec> readSweep(const YamlNode& root) {
  const YamlNode* node = root.find(kSweep);
  if (node == nullptr) {
    return {};
  }
  SweepSpec sweep;
  readValue(*node, sweep);
  return sweep;
}

YamlNode withoutSweep(YamlNode root) {
  return withoutKey(std::move(root), kSweep);
}

}  // namespace twinmap
