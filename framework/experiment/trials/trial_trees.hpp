#pragma once

#include <string>
#include <vector>

#include "framework/experiment/yaml/yaml_node.hpp"

namespace twinmap {

/// One of several experiments with the same machine (`trials:` of the file).
struct Trial {
  std::string name;  ///< "" of a file without trials
  YamlNode tree;     ///< that of a file that describes this trial alone
};

/// The trials of an experiment's tree, in the file's order: what a trial gives (excitation, initial, outputs,
/// features, noise, nuisance, inputs, constants, simulation, measurement) stands in the place of the file's
/// section of that name, which the others share. The tree itself where it has none. Throws ExperimentError
/// for another section, such as the machine's own, and for trials without one.
std::vector<Trial> expandTrials(const YamlNode& root);

/// Whether the tree describes several trials.
bool hasTrials(const YamlNode& root);

/// The tree of expandTrials(): what trials have of their own is taken from `trials` and left out of `shared`.
YamlNode joinTrials(YamlNode shared, const std::vector<Trial>& trials);

/// The tree of the one trial that `trial: NAME` chooses (also by an override trial=NAME, and the first of a
/// sweep over `trial`); the tree itself where it has none, or none is chosen. Throws ExperimentError for an
/// unknown one.
YamlNode selectTrial(const YamlNode& root);

/// The tree of all trials, whichever is chosen: what recordings that name their trials are of.
YamlNode selectAllTrials(YamlNode root);

}  // namespace twinmap
