#include <yaml-cpp/emitter.h>

#include <algorithm>

#include "framework/experiment/yaml/yaml_node.hpp"

namespace twinmap {
namespace {

bool isScalar(const YamlNode& node) {
  return node.kind == YamlNode::Kind::kScalar;
}

/// Lists of scalars and leaf maps of at most three scalars read best on one line.
bool fitsOneLine(const YamlNode& node) {
  constexpr std::size_t kMaxOnOneLine = 3;
  const bool scalar_list = std::all_of(node.items.begin(), node.items.end(), isScalar);
  const bool leaf_map = std::all_of(node.entries.begin(), node.entries.end(), [](const YamlEntry& entry) {
    return isScalar(entry.value) || (!entry.value.items.empty() && fitsOneLine(entry.value));
  });
  return scalar_list && leaf_map && node.entries.size() <= kMaxOnOneLine;
}

void emit(YAML::Emitter& out, const YamlNode& node) {
  switch (node.kind) {
    case YamlNode::Kind::kNull:
      out << YAML::Null;
      break;
    case YamlNode::Kind::kScalar:
      if (node.quoted) {
        out << YAML::DoubleQuoted;
      }
      out << node.scalar;
      break;
    case YamlNode::Kind::kSequence:
      out << (fitsOneLine(node) ? YAML::Flow : YAML::Block) << YAML::BeginSeq;
      for (const YamlNode& item : node.items) {
        emit(out, item);
      }
      out << YAML::EndSeq;
      break;
    case YamlNode::Kind::kMap:
      out << (fitsOneLine(node) ? YAML::Flow : YAML::Block) << YAML::BeginMap;
      for (const YamlEntry& entry : node.entries) {
        out << YAML::Key << entry.key << YAML::Value;
        emit(out, entry.value);
      }
      out << YAML::EndMap;
      break;
  }
}

}  // namespace

std::string writeYaml(const YamlNode& root) {
  YAML::Emitter out;
  emit(out, root);
  return std::string(out.c_str()) + "\n";
}

}  // namespace twinmap
