#include "framework/experiment/expression/named_values.hpp"

#include <algorithm>
#include <stdexcept>

#include "framework/base/text/nearest_name.hpp"

namespace twinmap {
namespace {

/// The nearest name or, where none is near, all there are, but for those that a reader would not go through.
std::string suggestKnown(const std::string& name, const std::vector<std::string>& names) {
  constexpr std::size_t kMost = 24;
  if (std::string nearest = suggestName(name, names); !nearest.empty() || names.empty()) {
    return nearest;
  }
  const std::vector<std::string> first(names.begin(), names.begin() + std::min(names.size(), kMost));
  return " (known: " + listNames(first) + (names.size() > kMost ? ", ...)" : ")");
}

}  // namespace

int DefinedNames::addName(const std::string& name) {
  const int place = static_cast<int>(names_.size());
  if (!places_.emplace(name, place).second) {
    throw std::invalid_argument("the name '" + name + "' is defined twice");
  }
  names_.push_back(name);
  return place;
}

int DefinedNames::findPlace(const std::string& name) const {
  const auto found = places_.find(name);
  return found == places_.end() ? -1 : found->second;
}

void DefinedNames::defineFunction(const std::string& name, FunctionExpansion expansion) {
  if (!functions_.emplace(name, std::move(expansion)).second) {
    throw std::invalid_argument("the function '" + name + "' is defined twice");
  }
}

BoundExpression DefinedNames::bind(const Expression& expression) const {
  const ExpressionTree tree = parseExpression(expression);
  BoundExpression bound;
  std::vector<int> places;  // of the tree's nodes: functions are longer
  for (ExpressionTree::Node node : tree.nodes) {
    if (node.operation == program::Operation::kParameter) {
      const std::string& name = tree.names[node.operands[0]];
      node.operands[0] = findPlace(name);
      if (node.operands[0] < 0) {
        throw ExperimentError(expression.where, expression.text,
                              "uses the unknown name '" + name + "'" + suggestKnown(name, getNames()));
      }
    } else {
      for (int& operand : node.operands) {
        operand = operand < 0 ? operand : places[operand];
      }
    }
    if (node.call < 0) {
      bound.nodes.push_back(node);
      places.push_back(static_cast<int>(bound.nodes.size()) - 1);
    } else {
      places.push_back(findFunction(tree.calls[node.call], expression)(bound.nodes, node.operands[0]));
    }
  }
  return bound;
}

const FunctionExpansion& DefinedNames::findFunction(const ExpressionTree::Call& call,
                                                    const Expression& expression) const {
  const auto found = functions_.find(call.name);
  if (found == functions_.end()) {
    std::vector<std::string> known = listFunctions();
    for (const auto& [name, expansion] : functions_) {
      known.push_back(name);
    }
    throw ExperimentError(expression.where, expression.text,
                          "is not a valid expression: there is no function '" + call.name +
                              "' at character " + std::to_string(call.character) +
                              suggestName(call.name, known));
  }
  return found->second;
}

}  // namespace twinmap
