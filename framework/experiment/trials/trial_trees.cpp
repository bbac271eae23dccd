#include "framework/experiment/trials/trial_trees.hpp"

#include <algorithm>
#include <array>
#include <cctype>

#include "framework/base/text/nearest_name.hpp"

namespace twinmap {
namespace {

constexpr const char* kTrials = "trials";
constexpr const char* kTrial = "trial";
constexpr const char* kSweep = "sweep";
constexpr const char* kTransform = "transform";
constexpr const char* kDescription = "description";

/// What may differ between experiments with one machine.
constexpr std::array kOwnSections = {"excitation", "initial",     "outputs",  "features",
                                     "noise",      "nuisance",    "inputs",   "constants",
                                     "simulation", "measurement", kTransform, kDescription};

void eraseEntry(YamlNode& map, const std::string& key) {
  map.entries.erase(std::remove_if(map.entries.begin(), map.entries.end(),
                                   [&](const YamlEntry& entry) { return entry.key == key; }),
                    map.entries.end());
}

bool isOwnSection(const std::string& key) {
  return std::find(kOwnSections.begin(), kOwnSections.end(), key) != kOwnSections.end();
}

void requireOwnSection(const YamlEntry& section) {
  if (!isOwnSection(section.key)) {
    const std::vector<std::string> names(kOwnSections.begin(), kOwnSections.end());
    throw ExperimentError(section.key_where, section.key,
                          "is not a section that a trial may have of its own (" + listNames(names) +
                              "); the machine and its parameters are shared by all trials" +
                              suggestName(section.key, names));
  }
}

/// Names of outputs, columns and folders begin with it.
void requirePlainName(const YamlEntry& trial) {
  const auto is_plain = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '-'; };
  if (trial.key.empty() || !std::all_of(trial.key.begin(), trial.key.end(), is_plain)) {
    throw ExperimentError(trial.key_where, trial.key,
                          "names a trial: use letters, digits, '_' and '-' alone");
  }
}

Trial makeTrial(const YamlNode& base, const YamlEntry& entry) {
  requirePlainName(entry);
  if (entry.value.kind != YamlNode::Kind::kMap) {
    throw ExperimentError(entry.key_where, entry.key,
                          "must be a map of the sections that are this trial's own");
  }
  Trial trial{entry.key, base};
  for (const YamlEntry& section : entry.value.entries) {
    requireOwnSection(section);
    eraseEntry(trial.tree, section.key);
    trial.tree.entries.push_back(section);
  }
  return trial;
}

/// The value that `trial` has, or would have first in a sweep; null without one.
const YamlNode* findChoice(const YamlNode& root) {
  if (const YamlNode* chosen = root.find(kTrial)) {
    return chosen;
  }
  const YamlNode* sweep = root.find(kSweep);
  const YamlNode* over = sweep != nullptr ? sweep->find("over") : nullptr;
  const YamlNode* swept = over != nullptr ? over->find(kTrial) : nullptr;
  return swept != nullptr && !swept->items.empty() ? &swept->items.front() : nullptr;
}

}  // namespace

std::vector<Trial> expandTrials(const YamlNode& root) {
  const YamlNode* trials = root.find(kTrials);
  if (trials == nullptr) {
    return {{"", root}};
  }
  if (trials->kind != YamlNode::Kind::kMap || trials->entries.empty()) {
    throw ExperimentError(trials->where, describeValue(*trials),
                          "must be a map from names of trials to sections");
  }
  YamlNode base = root;
  eraseEntry(base, kTrials);
  eraseEntry(base, kTrial);
  std::vector<Trial> expanded;
  for (const YamlEntry& entry : trials->entries) {
    expanded.push_back(makeTrial(base, entry));
  }
  return expanded;
}

bool hasTrials(const YamlNode& root) {
  return root.find(kTrials) != nullptr;
}

YamlNode joinTrials(YamlNode shared, const std::vector<Trial>& trials) {
  YamlNode own = makeMap();
  for (const Trial& trial : trials) {
    own.entries.push_back({trial.name, {}, makeMap()});
    for (const YamlEntry& section : trial.tree.entries) {
      if (isOwnSection(section.key) && section.key != kTransform && section.key != kDescription) {
        own.entries.back().value.entries.push_back(section);
        eraseEntry(shared, section.key);
      }
    }
  }
  shared.entries.push_back({kTrials, {}, std::move(own)});
  return shared;
}

YamlNode selectTrial(const YamlNode& root) {
  const YamlNode* chosen = findChoice(root);
  if (!hasTrials(root) || chosen == nullptr) {
    return root;
  }
  std::vector<Trial> trials = expandTrials(root);
  std::vector<std::string> names;
  for (const Trial& trial : trials) {
    names.push_back(trial.name);
  }
  const auto found = std::find(names.begin(), names.end(), chosen->scalar);
  if (found == names.end()) {
    throw ExperimentError(
        chosen->where, chosen->scalar,
        "must be one of the trials " + listNames(names) + suggestName(chosen->scalar, names));
  }
  return std::move(trials[static_cast<std::size_t>(found - names.begin())].tree);
}

YamlNode selectAllTrials(YamlNode root) {
  if (hasTrials(root)) {
    eraseEntry(root, kTrial);
    eraseEntry(root, kSweep);
  }
  return root;
}

}  // namespace twinmap
