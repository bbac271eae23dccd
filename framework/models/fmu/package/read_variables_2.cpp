#include <map>

#include "framework/models/fmu/package/read_variables.hpp"

namespace twinmap::fmi {
namespace {

const std::map<std::string, Type> kTypes{{"Real", Type::kFloat64},
                                         {"Integer", Type::kInt32},
                                         {"Boolean", Type::kBoolean},
                                         {"String", Type::kString},
                                         {"Enumeration", Type::kEnumeration}};

/// The <Real>, <Integer> ... of a <ScalarVariable> or <SimpleType>.
pugi::xml_node findTyped(const pugi::xml_node& node) {
  for (const pugi::xml_node& child : node.children()) {
    if (kTypes.count(child.name()) > 0) {
      return child;
    }
  }
  return {};
}

using DeclaredTypes = std::map<std::string, pugi::xml_node>;

DeclaredTypes collectSimpleTypes(const pugi::xml_node& root) {
  DeclaredTypes types;
  for (const pugi::xml_node& type : root.child("TypeDefinitions").children("SimpleType")) {
    types[type.attribute("name").value()] = findTyped(type);
  }
  return types;
}

Variable readScalarVariable(const pugi::xml_node& node, const DeclaredTypes& types, const XmlFile& file) {
  Variable variable;
  const pugi::xml_node typed = findTyped(node);
  if (!typed) {
    file.fail("variable '" + std::string(node.attribute("name").value()) +
              "' has none of Real, Integer, Boolean, String, Enumeration");
  }
  variable.type = kTypes.at(typed.name());
  const auto declared = types.find(typed.attribute("declaredType").value());
  readAttributes(node, typed, declared == types.end() ? pugi::xml_node() : declared->second, file, variable);
  if (typed.attribute("derivative")) {
    variable.derivative_of = static_cast<int>(requireIndex(typed, "derivative", file)) - 1;  // counted from 1
  }
  return variable;
}

}  // namespace

std::vector<Variable> readVariables2(const pugi::xml_node& root, const XmlFile& file) {
  const DeclaredTypes types = collectSimpleTypes(root);
  std::vector<Variable> variables;
  for (const pugi::xml_node& node : root.child("ModelVariables").children("ScalarVariable")) {
    variables.push_back(readScalarVariable(node, types, file));
  }
  for (const Variable& variable : variables) {
    if (variable.derivative_of >= static_cast<int>(variables.size())) {
      file.fail("variable '" + variable.name + "' is the derivative of none of the variables");
    }
  }
  return variables;
}

}  // namespace twinmap::fmi
