#include <map>

#include "framework/models/fmu/package/read_variables.hpp"

namespace twinmap::fmi {
namespace {

const std::map<std::string, Type>& getTypes() {
  static const std::map<std::string, Type> kByName = [] {
    std::map<std::string, Type> types;
    for (int i = 0; i <= static_cast<int>(Type::kClock); ++i) {
      types[toText(static_cast<Type>(i))] = static_cast<Type>(i);
    }
    return types;
  }();
  return kByName;
}

using Nodes = std::map<std::string, pugi::xml_node>;

/// <Float64Type name=...> and its like.
Nodes collectTypeNodes(const pugi::xml_node& root) {
  Nodes types;
  for (const pugi::xml_node& type : root.child("TypeDefinitions").children()) {
    types[type.attribute("name").value()] = type;
  }
  return types;
}

/// Sizes that variables give, by value reference.
Nodes collectReferences(const pugi::xml_node& variables) {
  Nodes references;
  for (const pugi::xml_node& node : variables.children()) {
    references[node.attribute("valueReference").value()] = node;
  }
  return references;
}

std::size_t readSize(const pugi::xml_node& dimension, const Nodes& references, const XmlFile& file) {
  constexpr std::uint32_t kLargest = 1000000;  // elements; an array is set and read as a whole
  const auto source = references.find(dimension.attribute("valueReference").value());
  const bool fixed = static_cast<bool>(dimension.attribute("start"));
  if (!fixed && source == references.end()) {
    file.fail("a <Dimension> has neither start nor the valueReference of a variable");
  }
  const std::uint32_t size = requireIndex(fixed ? dimension : source->second, "start", file);
  if (size > kLargest) {
    file.fail("a <Dimension> of " + std::to_string(size) + " is more than a million");
  }
  return size;
}

Variable readTypedVariable(const pugi::xml_node& node, const Nodes& types, const Nodes& references,
                           const XmlFile& file) {
  Variable variable;
  variable.type = getTypes().at(node.name());
  const auto declared = types.find(node.attribute("declaredType").value());
  readAttributes(node, node, declared == types.end() ? pugi::xml_node() : declared->second, file, variable);
  for (const pugi::xml_node& dimension : node.children("Dimension")) {
    variable.dimensions.push_back(readSize(dimension, references, file));
  }
  variable.timed_clock = variable.type == Type::kClock && variable.causality == Causality::kInput &&
                         node.attribute("intervalVariability").value() != std::string("triggered");
  if (variable.start.empty() && node.child("Start")) {  // of String and Binary
    variable.start = node.child("Start").attribute("value").value();
  }
  return variable;
}

void appendAliases(const pugi::xml_node& node, const Variable& variable, const XmlFile& file,
                   std::vector<Variable>& aliases) {
  for (const pugi::xml_node& alias : node.children("Alias")) {
    Variable copy = variable;
    copy.name = requireText(alias, "name", file);
    if (alias.attribute("description")) {
      copy.description = alias.attribute("description").value();
    }
    aliases.push_back(copy);
  }
}

/// From value references to indices.
void setDerivatives(const pugi::xml_node& variables, const XmlFile& file, std::vector<Variable>& read) {
  std::map<std::uint32_t, int> indices;
  for (std::size_t i = 0; i < read.size(); ++i) {
    indices.emplace(read[i].reference, static_cast<int>(i));
  }
  for (const pugi::xml_node& node : variables.children()) {
    if (node.attribute("derivative") && getTypes().count(node.name()) > 0) {
      const auto state = indices.find(requireIndex(node, "derivative", file));
      if (state == indices.end()) {
        file.fail("variable '" + std::string(node.attribute("name").value()) +
                  "' is the derivative of none of the variables");
      }
      read[indices.at(requireIndex(node, "valueReference", file))].derivative_of = state->second;
    }
  }
}

}  // namespace

std::vector<Variable> readVariables3(const pugi::xml_node& root, const XmlFile& file) {
  const pugi::xml_node nodes = root.child("ModelVariables");
  const Nodes types = collectTypeNodes(root), references = collectReferences(nodes);
  std::vector<Variable> variables, aliases;
  for (const pugi::xml_node& node : nodes.children()) {
    if (getTypes().count(node.name()) > 0) {  // and nothing that a later version adds
      variables.push_back(readTypedVariable(node, types, references, file));
      appendAliases(node, variables.back(), file, aliases);
    }
  }
  setDerivatives(nodes, file, variables);
  variables.insert(variables.end(), aliases.begin(), aliases.end());
  return variables;
}

}  // namespace twinmap::fmi
