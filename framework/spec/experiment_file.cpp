#include "framework/spec/experiment_file.hpp"

#include <algorithm>

#include "framework/spec/check/check_experiment.hpp"
#include "framework/spec/check/check_features.hpp"
#include "framework/spec/describe_experiment.hpp"
#include "framework/spec/describe_sweep.hpp"
#include "framework/spec/fields/overrides.hpp"
#include "framework/spec/fields/read_value.hpp"
#include "framework/spec/fields/write_value.hpp"
#include "framework/spec/noise_correlation.hpp"
#include "framework/spec/signal_files.hpp"
#include "framework/spec/sweep/swept_keys.hpp"

namespace twinmap {
namespace {

constexpr const char* kSweep = "sweep";

/// 8 standard deviations of the noise: independent noise alone exceeds that between two of 1000 samples in
/// less than 1 % of windows (1000^2 pairs, each with the probability Q(8 / sqrt 2) = 7.7e-9).
void resolveProminence(const NoiseSpec& noise, ExtremaFeatureSpec& extrema) {
  constexpr double kNoiseStddevs = 8.0;
  for (const OutputNoiseSpec& output : noise.stddev) {
    if (!extrema.prominence && output.name.text == extrema.output.text) {
      extrema.prominence = kNoiseStddevs * noise.scale * output.stddev;
    }
  }
}

/// Defaults that depend on other values.
void resolveDefaults(ExperimentSpec& experiment) {
  const std::vector<ParameterSpec>& parameters = experiment.model.parameters;
  if (experiment.report.over.empty() && parameters.size() >= 2) {
    experiment.report.over = {parameters[parameters.size() - 2].name, parameters.back().name};
  }
  if (experiment.transform.empty()) {
    experiment.transform.resize(2);
    const bool correlated = !experiment.noise.correlation.empty();
    experiment.transform[0].whiten = WhitenSpec{correlated ? WhitenBy::kCovariance : WhitenBy::kStddev};
    experiment.transform[1].principal_components.emplace();
    for (TransformStepSpec& step : experiment.transform) {
      step.where = {experiment.name.where.file, 0, 0, "transform"};
    }
  }
  resolveNoiseCorrelation(experiment);
  for (FeatureSpec& feature : experiment.features) {
    if (feature.extrema) {
      resolveProminence(experiment.noise, *feature.extrema);
    }
  }
  if (!experiment.noise.replicates) {
    constexpr int kMostReplicates = 4, kMostColumns = 3000;
    experiment.noise.replicates =
        std::clamp(kMostColumns / experiment.design.train.samples, 1, kMostReplicates);
  }
}

}  // namespace

ExperimentSpec readExperiment(const YamlNode& root) {
  ExperimentSpec experiment;
  readValue(withoutSweep(root), experiment);
  requireFewSamples(experiment.features, experiment.name.where);
  resolveDefaults(experiment);
  checkExperiment(experiment);
  return experiment;
}

YamlNode loadExperimentTree(const std::string& path, const std::vector<std::string>& overrides) {
  YamlNode root = loadYaml(path);
  for (const std::string& text : overrides) {
    applyOverride(root, text);
  }
  resolveSignalFiles(root, path);
  return root;
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
