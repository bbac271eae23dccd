#include "framework/experiment/tree/overrides.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>

#include "framework/experiment/tree/swept_keys.hpp"

namespace twinmap {
namespace {

const SourceLocation kCommandLine{"command line", 0, 0, ""};

/// What asks for a change of the tree: an override's text, or a swept key.
struct Change {
  std::string text;
  SourceLocation where;
};

[[noreturn]] void reject(const Change& change, const std::string& rule) {
  throw ExperimentError(change.where, change.text, rule);
}

bool isIndex(const std::string& step) {
  constexpr std::size_t kMaxDigits = 6;
  return step.size() > 2 && step.size() <= kMaxDigits + 2 && step.front() == '[' && step.back() == ']' &&
         std::all_of(step.begin() + 1, step.end() - 1, [](unsigned char c) { return std::isdigit(c) != 0; });
}

/// "a.b[0].c" -> {"a", "b", "[0]", "c"}.
std::vector<std::string> splitKeyPath(const std::string& path, const Change& change) {
  std::vector<std::string> steps(1);
  for (const char c : path) {
    if (c == '.') {
      steps.emplace_back();
    } else if (c == '[') {
      steps.emplace_back("[");
    } else {
      steps.back() += c;
    }
  }
  constexpr std::size_t kMaxSteps = 20;
  if (steps.size() > kMaxSteps) {
    reject(change, "has a key path of more than 20 steps");
  }
  for (const std::string& step : steps) {
    if (step.empty() || (step.front() == '[' && !isIndex(step))) {
      reject(change, "has a malformed key path; write it like system.springs[0].stiffness");
    }
  }
  return steps;
}

/// Line and column within an override's own text help nobody.
void dropPositions(YamlNode& node) {
  node.where = kCommandLine;
  for (YamlNode& item : node.items) {
    dropPositions(item);
  }
  for (YamlEntry& entry : node.entries) {
    entry.key_where = kCommandLine;
    dropPositions(entry.value);
  }
}

YamlNode& descend(YamlNode& node, const std::string& step, const Change& change) {
  if (isIndex(step)) {
    const std::size_t index = std::stoul(step.substr(1));
    if (index >= node.items.size()) {
      reject(change,
             fmt::format("names {} of a list with {} items; indices start at 0", step, node.items.size()));
    }
    return node.items[index];
  }
  if (node.kind == YamlNode::Kind::kNull) {
    node.kind = YamlNode::Kind::kMap;
  }
  if (node.kind != YamlNode::Kind::kMap) {
    reject(change, "goes below '" + node.where.key_path + "', which is " + describeValue(node));
  }
  if (YamlNode* child = node.find(step)) {
    return *child;
  }
  node.entries.push_back({step, change.where, YamlNode{}});
  node.entries.back().value.where = change.where;
  return node.entries.back().value;
}

/// The value at a key path; made, with the maps on the way, where it is missing.
YamlNode& findOrMake(YamlNode& root, const std::string& key, const Change& change) {
  YamlNode* node = &root;
  for (const std::string& step : splitKeyPath(key, change)) {
    node = &descend(*node, step, change);
  }
  return *node;
}

/// Splits at the commas outside brackets and quotes.
std::vector<std::string> splitValues(const std::string& text) {
  std::vector<std::string> values(1);
  int depth = 0;
  char quote = '\0';
  for (const char c : text) {
    if (quote != '\0') {
      quote = c == quote ? '\0' : quote;
    } else if (c == '\'' || c == '"') {
      quote = c;
    } else {
      depth += std::string("([{").find(c) != std::string::npos ? 1 : 0;
      depth -= std::string(")]}").find(c) != std::string::npos ? 1 : 0;
    }
    if (c == ',' && depth == 0 && quote == '\0') {
      values.emplace_back();
    } else {
      values.back() += c;
    }
  }
  return values;
}

YamlNode parseValue(const std::string& text) {
  YamlNode node = parseYaml(text, kCommandLine.file);
  dropPositions(node);
  return node;
}

YamlNode parseValues(const std::vector<std::string>& texts, const Change& change) {
  YamlNode values = makeSequence();
  for (const std::string& text : texts) {
    values.items.push_back(parseValue(text));
    if (values.items.back().kind == YamlNode::Kind::kNull) {
      reject(change, "has an empty value in its list");
    }
  }
  return values;
}

/// Sweeps the key over the values, instead of those the file gives.
void setSweptValues(YamlNode& root, const std::string& key, YamlNode values, const Change& change) {
  splitKeyPath(key, change);  // finds a malformed one
  YamlNode& over = descend(descend(root, "sweep", change), "over", change);
  descend(over, key, change) = std::move(values);
}

/// A key that has one value is no longer swept; without any other, nothing is.
void endSweepOf(const std::string& key, YamlNode& root) {
  YamlNode* sweep = root.find("sweep");
  YamlNode* over = sweep == nullptr ? nullptr : sweep->find("over");
  if (over == nullptr || over->find(key) == nullptr) {
    return;
  }
  const auto erase = [](const std::string& name, std::vector<YamlEntry>& entries) {
    entries.erase(std::remove_if(entries.begin(), entries.end(),
                                 [&](const YamlEntry& entry) { return entry.key == name; }),
                  entries.end());
  };
  erase(key, over->entries);
  if (over->entries.empty()) {
    erase("sweep", root.entries);
  }
}

/// That a parameter's value is not asked for by the parameter's name alone.
void requireNoParameter(const YamlNode& root, const std::string& key, const Change& change) {
  const YamlNode* parameters = root.find("parameters");
  if (parameters != nullptr && parameters->find(key) != nullptr && root.find(key) == nullptr) {
    reject(change, fmt::format("names a parameter: write parameters.{}", change.text));
  }
}

}  // namespace

void applyOverride(YamlNode& root, const std::string& override_text) {
  const Change change{override_text, kCommandLine};
  const std::size_t equals = override_text.find('=');
  if (equals == std::string::npos || equals == 0) {
    reject(change, "is not an override; write key.path=value, as in noise.scale=2");
  }
  const std::string key = override_text.substr(0, equals);
  const std::string value = override_text.substr(equals + 1);
  const std::vector<std::string> values = splitValues(value);
  requireNoParameter(root, key, change);
  if (isSweepable(key) && (values.size() > 1 || isRange(value))) {
    setSweptValues(root, key, parseValues(values, change), change);
  } else {
    endSweepOf(key, root);
    findOrMake(root, key, change) = parseValue(value);
  }
  setKeyPaths(root, "");
}

void setValue(YamlNode& root, const Name& key, const YamlNode& value) {
  findOrMake(root, key.text, {key.text, key.where}) = value;
  setKeyPaths(root, "");
}

const YamlNode* findValue(const YamlNode& root, const Name& key) {
  const YamlNode* node = &root;
  for (const std::string& step : splitKeyPath(key.text, {key.text, key.where})) {
    if (!isIndex(step)) {
      node = node->find(step);
    } else {
      const std::size_t index = std::stoul(step.substr(1));
      node = index < node->items.size() ? &node->items[index] : nullptr;
    }
    if (node == nullptr) {
      return nullptr;
    }
  }
  return node;
}

}  // namespace twinmap
