#include "framework/experiment/experiment_file.hpp"

#include <algorithm>

#include "framework/experiment/check/check_experiment.hpp"
#include "framework/experiment/check/check_features.hpp"
#include "framework/experiment/fields/overrides.hpp"
#include "framework/experiment/fields/read_value.hpp"
#include "framework/experiment/fields/write_value.hpp"
#include "framework/experiment/files/prior_files.hpp"
#include "framework/experiment/files/signal_files.hpp"
#include "framework/experiment/resolve_defaults.hpp"
#include "framework/experiment/sweep/swept_keys.hpp"
#include "framework/experiment/sweep/trials.hpp"

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

/// With its defaults resolved.
ExperimentSpec readUnchecked(const YamlNode& root) {
  ExperimentSpec experiment;
  readValue(withoutSweep(selectTrial(root)), experiment);
  requireFewSamples(experiment.features, experiment.name.where);
  resolveDefaults(experiment);
  return experiment;
}

}  // namespace

ExperimentSpec readExperiment(const YamlNode& root) {
  const ExperimentSpec experiment = readUnchecked(root);
  checkExperiment(experiment);
  return experiment;
}

ExperimentSpec readExperimentOfCheckedModel(const YamlNode& root) {
  const ExperimentSpec experiment = readUnchecked(root);
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
  return writeYaml(writeValue(experiment));
}

ExperimentSpec readResolved(const std::string& text) {
  ExperimentSpec experiment;
  readValue(parseYaml(text, "resolved.yaml"), experiment);
  return experiment;
}

std::string writeIndependentDefaults(const YamlNode& root) {
  if (root.find("trials") != nullptr) {
    return writeYaml(root);  // each trial has defaults of its own
  }
  ExperimentSpec experiment;
  readValue(withoutSweep(root), experiment);
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
  root.entries.erase(std::remove_if(root.entries.begin(), root.entries.end(),
                                    [](const YamlEntry& entry) { return entry.key == kSweep; }),
                     root.entries.end());
  return root;
}

}  // namespace twinmap
