#pragma once

#include <string>
#include <vector>

#include "framework/experiment/experiment_spec.hpp"
#include "framework/experiment/yaml/yaml_node.hpp"

namespace twinmap {

/// One experiment of a sweep.
struct SweepCase {
  std::string name;                 ///< "samples-50_scale-0.25_seed-1": unique, fit to name a folder
  std::vector<std::string> values;  ///< of each swept key, as text
  ExperimentSpec experiment;        ///< checked
  int model = 0;                    ///< the first case whose swept values give the same model
};

/// The cases of an experiment's tree with a sweep, in the order of the sweep's lists, the last key first to
/// change. Throws ExperimentError for the first thing wrong in any of them, at the value it comes from, for
/// lists of different lengths to zip, and for more than 10000 cases. Cost: some 0.2 ms a case, and 1 ms a
/// model.
std::vector<SweepCase> expandSweep(const YamlNode& root);

/// The cases of a sweep, or the experiment itself as the only one, without a name.
std::vector<SweepCase> expandCases(const YamlNode& root);

/// The key paths of the sweep of an experiment's tree, in its order; none without a sweep.
std::vector<std::string> listSweptKeys(const YamlNode& root);

}  // namespace twinmap
