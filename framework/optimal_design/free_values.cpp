#include "framework/optimal_design/free_values.hpp"

#include <algorithm>
#include <set>

#include "framework/base/text/number_text.hpp"
#include "framework/experiment/tree/overrides.hpp"
#include "framework/simulation/excitation/excitation_terms.hpp"

namespace twinmap::experiment_design {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

bool endsWith(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

/// The list's key without a trailing index: "a.phases[2]" -> "a.phases".
std::string getListKey(const std::string& key) {
  return key.back() == ']' ? key.substr(0, key.rfind('[')) : key;
}

YamlNode* findIn(YamlNode& tree, const Name& key) {
  return const_cast<YamlNode*>(findValue(tree, key));  // the tree itself is not const
}

void removeKey(YamlNode& map, const std::string& key) {
  map.entries.erase(std::remove_if(map.entries.begin(), map.entries.end(),
                                   [&](const YamlEntry& entry) { return entry.key == key; }),
                    map.entries.end());
}

/// Writes out Schroeder's phases, or the amplitude for each, where a multisine leaves its list out.
void writeOutList(YamlNode& tree, const Name& free) {
  const std::string list = getListKey(free.text);
  const bool phases = endsWith(list, ".phases");
  const std::size_t dot = list.rfind('.');
  if ((!phases && !endsWith(list, ".amplitudes")) || findValue(tree, {list, free.where}) != nullptr) {
    return;
  }
  YamlNode* multisine = findIn(tree, {list.substr(0, dot), free.where});
  const YamlNode* frequencies = multisine == nullptr ? nullptr : multisine->find("frequencies");
  const YamlNode* amplitude = multisine == nullptr ? nullptr : multisine->find("amplitude");
  if (frequencies == nullptr || (!phases && amplitude == nullptr)) {
    return;
  }
  YamlNode values = makeSequence();
  if (phases) {
    for (const double phase : calcSchroederPhases(static_cast<int>(frequencies->items.size()))) {
      values.items.push_back(makeScalar(toText(phase)));
    }
  } else {
    values.items.assign(frequencies->items.size(), *amplitude);
    removeKey(*multisine, "amplitude");
  }
  setValue(tree, {list, free.where}, values);
}

FreeNumber makeNumber(const std::string& key, const YamlNode& node, const FreeValue& free) {
  FreeNumber number{key, free.bounds.lower, free.bounds.upper, 0.0, false, free.key.where};
  number.is_phase = endsWith(getListKey(key), ".phases") || endsWith(key, ".phase");
  if (node.kind != YamlNode::Kind::kScalar || !parseLiteral(node.scalar, number.present)) {
    throw ExperimentError(free.key.where, key,
                          "must be a plain number of the excitation to be free; it is " +
                              describeValue(node) + (node.items.empty() ? "" : "; {each: [lower, upper]}"));
  }
  number.present = std::clamp(number.present, number.lower, number.upper);
  return number;
}

/// "F.pulses[0].start" or, of a trial, "step.F.pulses[0].start": where that is in the tree.
std::string findPath(const std::string& key, const YamlNode& tree) {
  const std::size_t dot = key.find('.');
  const YamlNode* trials = tree.find("trials");
  if (trials == nullptr || dot == std::string::npos || trials->find(key.substr(0, dot)) == nullptr) {
    return "excitation." + key;
  }
  return "trials." + key.substr(0, dot) + ".excitation." + key.substr(dot + 1);
}

void appendNumbers(const FreeValue& free, YamlNode& tree, std::vector<FreeNumber>& numbers) {
  const Name key{findPath(free.key.text, tree), free.key.where};
  writeOutList(tree, key);
  const YamlNode* node = findValue(tree, key);
  if (node == nullptr) {
    throw ExperimentError(key.where, free.key.text, "is not a value of the excitation");
  }
  if (!free.each) {
    numbers.push_back(makeNumber(key.text, *node, free));
    return;
  }
  if (node->kind != YamlNode::Kind::kSequence || node->items.empty()) {
    throw ExperimentError(key.where, free.key.text, "must be a list for 'each'");
  }
  for (std::size_t i = 0; i < node->items.size(); ++i) {
    numbers.push_back(makeNumber(key.text + "[" + std::to_string(i) + "]", node->items[i], free));
  }
}

}  // namespace

std::vector<FreeNumber> resolveFreeNumbers(const FreeValues& free, YamlNode& tree) {
  std::vector<FreeNumber> numbers;
  for (const FreeValue& value : free.values) {
    appendNumbers(value, tree, numbers);
  }
  std::set<std::string> seen;
  for (const FreeNumber& number : numbers) {
    if (!seen.insert(number.key).second) {
      throw ExperimentError(number.where, number.key, "is made free twice");
    }
  }
  return numbers;
}

VectorXd calcPresentPoint(const std::vector<FreeNumber>& numbers) {
  return VectorXd::NullaryExpr(static_cast<Index>(numbers.size()), [&](Index i) {
    return (numbers[i].present - numbers[i].lower) / (numbers[i].upper - numbers[i].lower);
  });
}

VectorXd calcValues(const std::vector<FreeNumber>& numbers, const VectorXd& fractions) {
  return VectorXd::NullaryExpr(fractions.size(), [&](Index i) {
    return numbers[i].lower + fractions[i] * (numbers[i].upper - numbers[i].lower);
  });
}

YamlNode setValues(YamlNode tree, const std::vector<FreeNumber>& numbers, const VectorXd& values) {
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const SourceLocation& where = numbers[i].where;
    YamlNode value = makeScalar(toText(values[static_cast<Index>(i)]));
    value.where = where;
    setValue(tree, {numbers[i].key, where}, value);
  }
  return tree;
}

}  // namespace twinmap::experiment_design
