#include "framework/spec/overrides.hpp"

#include <algorithm>
#include <cctype>

namespace twinmap {
namespace {

const SourceLocation kCommandLine{"command line", 0, 0, ""};

[[noreturn]] void reject(const std::string& override_text, const std::string& rule) {
  throw ExperimentError(kCommandLine, override_text, rule);
}

/// "a.b[0].c" -> {"a", "b", "[0]", "c"}.
std::vector<std::string> splitKeyPath(const std::string& path) {
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
  return steps;
}

bool isIndex(const std::string& step) {
  constexpr std::size_t kMostDigits = 6;
  return step.size() > 2 && step.size() <= kMostDigits + 2 && step.front() == '[' && step.back() == ']' &&
         std::all_of(step.begin() + 1, step.end() - 1, [](unsigned char c) { return std::isdigit(c) != 0; });
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

YamlNode& descend(YamlNode& node, const std::string& step, const std::string& override_text) {
  if (isIndex(step)) {
    const std::size_t index = std::stoul(step.substr(1));
    if (index >= node.items.size()) {
      reject(override_text, "names " + step + " of a list with " + std::to_string(node.items.size()) +
                                " items; indices start at 0");
    }
    return node.items[index];
  }
  if (node.kind == YamlNode::Kind::kNull) {
    node.kind = YamlNode::Kind::kMap;
  }
  if (node.kind != YamlNode::Kind::kMap) {
    reject(override_text, "goes below '" + node.where.key_path + "', which is " + describeValue(node));
  }
  if (YamlNode* child = node.find(step)) {
    return *child;
  }
  node.entries.push_back({step, kCommandLine, YamlNode{}});
  node.entries.back().value.where = kCommandLine;
  return node.entries.back().value;
}

}  // namespace

void applyOverride(YamlNode& root, const std::string& override_text) {
  const std::size_t equals = override_text.find('=');
  if (equals == std::string::npos || equals == 0) {
    reject(override_text, "is not an override; write key.path=value, as in noise.scale=2");
  }
  YamlNode* node = &root;
  for (const std::string& step : splitKeyPath(override_text.substr(0, equals))) {
    if (step.empty() || (step.front() == '[' && !isIndex(step))) {
      reject(override_text, "has a malformed key path; write it like system.springs[0].stiffness");
    }
    node = &descend(*node, step, override_text);
  }
  *node = parseYaml(override_text.substr(equals + 1), kCommandLine.file);
  dropPositions(*node);
  setKeyPaths(root, "");
}

}  // namespace twinmap
