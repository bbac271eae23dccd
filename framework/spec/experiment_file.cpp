#include "framework/spec/experiment_file.hpp"

#include "framework/spec/check_experiment.hpp"
#include "framework/spec/describe_experiment.hpp"
#include "framework/spec/overrides.hpp"
#include "framework/spec/read_value.hpp"
#include "framework/spec/write_value.hpp"

namespace twinmap {

ExperimentSpec readExperiment(const YamlNode& root) {
  ExperimentSpec experiment;
  readValue(root, experiment);
  checkExperiment(experiment);
  return experiment;
}

ExperimentSpec loadExperiment(const std::string& path, const std::vector<std::string>& overrides) {
  YamlNode root = loadYaml(path);
  for (const std::string& text : overrides) {
    applyOverride(root, text);
  }
  return readExperiment(root);
}

std::string writeExperiment(const ExperimentSpec& experiment) { return writeYaml(writeValue(experiment)); }

}  // namespace twinmap
