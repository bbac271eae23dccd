#include "framework/experiment/files/sweep_cases.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <set>

#include "framework/experiment/files/experiment_file.hpp"
#include "framework/experiment/tree/overrides.hpp"
#include "framework/experiment/tree/read_value.hpp"

namespace twinmap {
namespace {

using Choice = std::vector<std::size_t>;  ///< index of the value of each key

constexpr std::size_t kMaxCases = 10000;

/// Harmless in the name of a folder.
bool isPlain(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '.' || c == '_' || c == '+';
}

Choice countValues(const SweepSpec& sweep) {
  Choice counts;
  for (const SweptKey& key : sweep.over.keys) {
    counts.push_back(key.values.size());
  }
  return counts;
}

std::vector<Choice> listGrid(const SweepSpec& sweep) {
  std::vector<Choice> choices{{}};
  for (const std::size_t count : countValues(sweep)) {
    std::vector<Choice> longer;
    for (const Choice& choice : choices) {
      for (std::size_t i = 0; i < count; ++i) {
        longer.push_back(choice);
        longer.back().push_back(i);
      }
    }
    choices = std::move(longer);
    if (choices.size() > kMaxCases) {
      throw ExperimentError(sweep.over.keys.front().where, "", "belongs to a sweep of more than 10000 cases");
    }
  }
  return choices;
}

std::vector<Choice> listZip(const SweepSpec& sweep) {
  const Choice counts = countValues(sweep);
  for (std::size_t k = 0; k < counts.size(); ++k) {
    if (counts[k] != counts[0]) {
      throw ExperimentError(sweep.over.keys[k].where, sweep.over.keys[k].key,
                            fmt::format("has {} values, '{}' has {}; 'combine: zip' needs as many", counts[k],
                                        sweep.over.keys[0].key, counts[0]));
    }
  }
  std::vector<Choice> choices;
  for (std::size_t i = 0; i < counts[0]; ++i) {
    choices.emplace_back(counts.size(), i);
  }
  return choices;
}

/// The last `count` steps of a key path: "train.samples" of "design.train.samples" for 2.
std::string takeLastSteps(const std::string& key, int count) {
  std::size_t begin = key.size();
  for (int i = 0; i < count && begin != std::string::npos && begin > 0; ++i) {
    begin = key.rfind('.', begin - 1);
  }
  return begin == std::string::npos ? key : key.substr(begin + 1);
}

/// As many last steps of the key path as tell it from the others: "samples", or "train.samples".
std::string makeKeyLabel(const std::string& key, const std::vector<SweptKey>& keys) {
  std::string label;
  for (int count = 1; label != key; ++count) {
    label = takeLastSteps(key, count);
    const bool unique = std::count_if(keys.begin(), keys.end(), [&](const SweptKey& other) {
                          return takeLastSteps(other.key, count) == label;
                        }) == 1;
    if (unique) {
      break;
    }
  }
  label.erase(std::remove_if(label.begin(), label.end(), [](char c) { return !isPlain(c); }), label.end());
  return label;
}

std::string makeValueLabel(const YamlNode& value) {
  std::string label = value.scalar;
  std::replace_if(
      label.begin(), label.end(), [](char c) { return !isPlain(c); }, '-');
  return label;
}

/// The values themselves where they are short, plain and distinct, else their numbers 1, 2 ...
std::vector<std::string> makeValueLabels(const std::vector<YamlNode>& values) {
  constexpr std::size_t kLongest = 24;
  std::vector<std::string> labels, numbers;
  bool fit = true;
  for (const YamlNode& value : values) {
    labels.push_back(makeValueLabel(value));
    numbers.push_back(std::to_string(numbers.size() + 1));
    fit = fit && value.kind == YamlNode::Kind::kScalar && !labels.back().empty() &&
          labels.back().size() <= kLongest;
  }
  const std::set<std::string> distinct(labels.begin(), labels.end());
  return fit && distinct.size() == labels.size() ? labels : numbers;
}

std::vector<std::string> makeNames(const SweepSpec& sweep, const std::vector<Choice>& choices) {
  constexpr std::size_t kLongest = 120;
  std::vector<std::string> names(choices.size());
  for (std::size_t k = 0; k < sweep.over.keys.size(); ++k) {
    const std::string key = makeKeyLabel(sweep.over.keys[k].key, sweep.over.keys);
    const std::vector<std::string> values = makeValueLabels(sweep.over.keys[k].values);
    for (std::size_t i = 0; i < choices.size(); ++i) {
      names[i] += (names[i].empty() ? "" : "_") + key + "-" + values[choices[i][k]];
    }
  }
  for (std::size_t i = 0; i < names.size(); ++i) {
    names[i] = names[i].size() <= kLongest ? names[i] : "case-" + std::to_string(i + 1);
  }
  return names;
}

/// Sections that no part of the model is read from.
constexpr std::array kBesideModel = {"seed",        "features",   "transform", "noise", "design",
                                     "inverse_map", "evaluation", "refine",    "trust", "gates",
                                     "measurement", "report",     "candidates"};

/// What a choice says of the model: equal for cases that have the same.
Choice selectModelValues(const Choice& choice, const std::vector<SweptKey>& keys) {
  Choice selected;
  for (std::size_t k = 0; k < choice.size(); ++k) {
    const std::string section = keys[k].key.substr(0, keys[k].key.find_first_of(".["));
    if (std::find(kBesideModel.begin(), kBesideModel.end(), section) == kBesideModel.end()) {
      selected.push_back(choice[k]);
    }
  }
  return selected;
}

std::string describeOnOneLine(const YamlNode& value) {
  std::string text = value.kind == YamlNode::Kind::kScalar ? value.scalar : writeYaml(value);
  text.erase(text.find_last_not_of(" \n") + 1);
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

}  // namespace

std::vector<SweepCase> expandSweep(const YamlNode& root) {
  readExperiment(root);
  const SweepSpec sweep = readSweep(root).value();
  const std::vector<Choice> choices = sweep.combine == SweepCombine::kGrid ? listGrid(sweep) : listZip(sweep);
  const std::vector<std::string> names = makeNames(sweep, choices);
  const YamlNode base = withoutSweep(root);
  std::vector<SweepCase> cases;
  std::map<Choice, int> models;
  for (std::size_t i = 0; i < choices.size(); ++i) {
    YamlNode tree = base;
    cases.push_back({names[i], {}, {}, 0});
    for (std::size_t k = 0; k < choices[i].size(); ++k) {
      const SweptKey& key = sweep.over.keys[k];
      setValue(tree, {key.key, key.where}, key.values[choices[i][k]]);
      cases.back().values.push_back(describeOnOneLine(key.values[choices[i][k]]));
    }
    const auto [model, is_new] =
        models.emplace(selectModelValues(choices[i], sweep.over.keys), static_cast<int>(i));
    cases.back().model = model->second;
    cases.back().experiment = is_new ? readExperiment(tree) : readExperimentOfCheckedModel(tree);
  }
  return cases;
}

std::vector<SweepCase> expandCases(const YamlNode& root) {
  if (root.find("sweep") != nullptr) {
    return expandSweep(root);
  }
  return {{"", {}, readExperiment(root), 0}};
}

std::vector<std::string> listSweptKeys(const YamlNode& root) {
  std::vector<std::string> keys;
  const std::optional<SweepSpec> sweep = readSweep(root);
  if (sweep) {
    for (const SweptKey& key : sweep->over.keys) {
      keys.push_back(key.key);
    }
  }
  return keys;
}

}  // namespace twinmap
