#include "framework/experiment/expression/named_values.hpp"

#include <stdexcept>

#include "framework/base/text/nearest_name.hpp"

namespace twinmap {

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

BoundExpression DefinedNames::bind(const Expression& expression) const {
  ExpressionTree tree = parseExpression(expression);
  for (ExpressionTree::Node& node : tree.nodes) {
    if (node.operation == program::Operation::kParameter) {
      const std::string& name = tree.names[node.operands[0]];
      node.operands[0] = findPlace(name);
      if (node.operands[0] < 0) {
        throw ExperimentError(expression.where, expression.text,
                              "uses the unknown name '" + name + "'" + suggestName(name, getNames()));
      }
    }
  }
  return {std::move(tree.nodes)};
}

}  // namespace twinmap
