#include "framework/experiment/yaml/yaml_node.hpp"

#include <algorithm>

namespace twinmap {
namespace {

/// "[4, 16]" of a short list of values, else "a list".
std::string describeList(const YamlNode& node) {
  constexpr std::size_t kMost = 6;
  std::string text;
  for (const YamlNode& item : node.items) {
    if (item.kind != YamlNode::Kind::kScalar || node.items.size() > kMost) {
      return "a list";
    }
    text += (text.empty() ? "" : ", ") + item.scalar;
  }
  return "[" + text + "]";
}

}  // namespace

YamlNode::YamlNode() = default;
YamlNode::YamlNode(const YamlNode&) = default;
YamlNode::YamlNode(YamlNode&&) noexcept = default;
YamlNode& YamlNode::operator=(const YamlNode&) = default;
YamlNode& YamlNode::operator=(YamlNode&&) noexcept = default;
YamlNode::~YamlNode() = default;

const YamlNode* YamlNode::find(const std::string& key) const {
  const auto found =
      std::find_if(entries.begin(), entries.end(), [&](const YamlEntry& entry) { return entry.key == key; });
  return found == entries.end() ? nullptr : &found->value;
}

YamlNode* YamlNode::find(const std::string& key) {
  return const_cast<YamlNode*>(static_cast<const YamlNode*>(this)->find(key));
}

YamlNode makeScalar(std::string text, bool quoted) {
  YamlNode node;
  node.kind = YamlNode::Kind::kScalar;
  node.scalar = std::move(text);
  node.quoted = quoted;
  return node;
}

YamlNode makeMap() {
  YamlNode node;
  node.kind = YamlNode::Kind::kMap;
  return node;
}

YamlNode makeSequence() {
  YamlNode node;
  node.kind = YamlNode::Kind::kSequence;
  return node;
}

std::string describeValue(const YamlNode& node) {
  switch (node.kind) {
    case YamlNode::Kind::kNull:
      return "nothing";
    case YamlNode::Kind::kSequence:
      return describeList(node);
    case YamlNode::Kind::kMap:
      return "a map";
    case YamlNode::Kind::kScalar:
      break;
  }
  return node.scalar;
}

void setKeyPaths(YamlNode& node, const std::string& key_path) {
  node.where.key_path = key_path;
  for (std::size_t i = 0; i < node.items.size(); ++i) {
    setKeyPaths(node.items[i], key_path + "[" + std::to_string(i) + "]");
  }
  for (YamlEntry& entry : node.entries) {
    const std::string path = key_path.empty() ? entry.key : key_path + "." + entry.key;
    entry.key_where.key_path = path;
    setKeyPaths(entry.value, path);
  }
}

}  // namespace twinmap
