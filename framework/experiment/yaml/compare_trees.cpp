#include "framework/experiment/yaml/compare_trees.hpp"

namespace twinmap {
namespace {

std::string join(const std::string& path, const std::string& key) {
  return path.empty() ? key : path + "." + key;
}

std::string listKeys(const YamlNode& map) {
  std::string listed;
  for (const YamlEntry& entry : map.entries) {
    listed += (listed.empty() ? "" : ", ") + entry.key;
  }
  return listed;
}

/// On one line, and no longer than is good to read.
std::string describe(const YamlNode& node) {
  constexpr std::size_t kLongest = 80;
  if (node.kind == YamlNode::Kind::kNull || node.kind == YamlNode::Kind::kScalar) {
    return describeValue(node);
  }
  std::string text;
  for (const char c : writeYaml(node)) {
    const bool space = c == ' ' || c == '\n';
    if (!space) {
      text += c;
    } else if (!text.empty() && text.back() != ' ') {
      text += ' ';
    }
  }
  text.erase(text.find_last_not_of(' ') + 1);
  return text.size() <= kLongest ? text : text.substr(0, kLongest) + "...";
}

class Comparison {
 public:
  void compare(const std::string& path, const YamlNode& before, const YamlNode& after) {
    if (before.kind == YamlNode::Kind::kMap && after.kind == YamlNode::Kind::kMap) {
      compareMaps(path, before, after);
    } else if (before.kind == YamlNode::Kind::kSequence && after.kind == YamlNode::Kind::kSequence &&
               before.items.size() == after.items.size()) {
      for (std::size_t i = 0; i < before.items.size(); ++i) {
        compare(path + "[" + std::to_string(i) + "]", before.items[i], after.items[i]);
      }
    } else if (writeYaml(before) != writeYaml(after)) {
      differences.push_back({path, describe(before), describe(after)});
    }
  }

  std::vector<KeyDifference> differences;

 private:
  void compareMaps(const std::string& path, const YamlNode& before, const YamlNode& after) {
    const std::size_t found_before = differences.size();
    for (const YamlEntry& entry : before.entries) {
      const YamlNode* other = after.find(entry.key);
      compareEntry(join(path, entry.key), entry.value, other == nullptr ? YamlNode{} : *other);
    }
    for (const YamlEntry& entry : after.entries) {
      if (before.find(entry.key) == nullptr) {
        compareEntry(join(path, entry.key), YamlNode{}, entry.value);
      }
    }
    const bool ordered = path == "parameters" || path == "nuisance" || path == "inputs" || path == "outputs";
    if (ordered && differences.size() == found_before && listKeys(before) != listKeys(after)) {
      differences.push_back({path, listKeys(before), listKeys(after)});
    }
  }

  void compareEntry(const std::string& path, const YamlNode& before, const YamlNode& after) {
    const bool text =
        before.items.empty() && before.entries.empty() && after.items.empty() && after.entries.empty();
    const bool description = text && path.substr(path.rfind('.') + 1) == "description";
    if (!description) {
      compare(path, before, after);
    }
  }
};

}  // namespace

std::vector<KeyDifference> compareTrees(const YamlNode& before, const YamlNode& after) {
  Comparison comparison;
  comparison.compare("", before, after);
  return comparison.differences;
}

}  // namespace twinmap
