#pragma once

#include <optional>
#include <string>
#include <vector>

#include "framework/experiment/experiment_spec.hpp"
#include "framework/experiment/tree/sweep_spec.hpp"
#include "framework/experiment/yaml/yaml_node.hpp"

namespace twinmap {

/// Reads an experiment from its YAML tree and checks it (see check_experiment.hpp). A sweep in the tree is no
/// part of it. Throws ExperimentError for the first thing wrong.
ExperimentSpec readExperiment(const YamlNode& root);

/// The same of a tree whose model has been checked in another.
ExperimentSpec readExperimentOfCheckedModel(const YamlNode& root);

/// Reads `path`, applies the overrides "key.path=value" in their order, checks the result.
ExperimentSpec loadExperiment(const std::string& path, const std::vector<std::string>& overrides = {});

/// The same as a tree, not checked yet. Names of files in it (measured signals) are relative to the folder of
/// `path`, and absolute from here on.
YamlNode loadExperimentTree(const std::string& path, const std::vector<std::string>& overrides = {});

/// The same of a text: `source`, which need not exist, stands for its file, in messages as well.
YamlNode parseExperimentTree(const std::string& text, const std::string& source,
                             const std::vector<std::string>& overrides = {});

/// The experiment as YAML with every default written out; reading it back gives the same experiment.
std::string writeExperiment(const ExperimentSpec& experiment);

/// Reads the text of writeExperiment() back, which has been checked. Throws ExperimentError for another text.
ExperimentSpec readResolved(const std::string& text);

/// The sweep of an experiment's tree, if there is one.
std::optional<SweepSpec> readSweep(const YamlNode& root);

/// The tree without its sweep.
YamlNode withoutSweep(YamlNode root);

/// The experiment of a tree, and its sweep, as YAML with those defaults written out that depend on no other
/// value, so that a sweep finds the others anew for each case.
std::string writeIndependentDefaults(const YamlNode& root);

}  // namespace twinmap
