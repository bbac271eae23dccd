#pragma once

#include <array>
#include <functional>
#include <map>
#include <string>
#include <unordered_map>
#include <vector>

#include "framework/base/text/number_text.hpp"
#include "framework/experiment/expression/algebra.hpp"
#include "framework/experiment/expression/expression_tree.hpp"

namespace twinmap {

/// An expression whose names are places in those of a NamedValues.
struct BoundExpression {
  std::vector<ExpressionTree::Node> nodes;
};

/// Writes the operations of a function down behind those that are there, from the place of its operand;
/// returns the place of its value.
using FunctionExpansion = std::function<int(std::vector<ExpressionTree::Node>& nodes, int operand)>;

/// Names in the order in which they were defined.
class DefinedNames {
 public:
  bool contains(const std::string& name) const { return places_.count(name) > 0; }
  const std::vector<std::string>& getNames() const { return names_; }

  /// Parses `expression` against the names. Throws ExperimentError (with its location) for a syntax error and
  /// for an unknown name (with the nearest known one, or all).
  BoundExpression bind(const Expression& expression) const;

  /// Lets expressions call a function of one operand. Throws std::invalid_argument if it exists already.
  void defineFunction(const std::string& name, FunctionExpansion expansion);
  /// Those of other names, which begin with the same ones.
  void takeFunctions(const DefinedNames& others) { functions_ = others.functions_; }

 protected:
  /// Adds a name; returns its place. Throws std::invalid_argument if it exists already.
  int addName(const std::string& name);
  int findPlace(const std::string& name) const;  ///< -1: none

 private:
  const FunctionExpansion& findFunction(const ExpressionTree::Call& call, const Expression& expression) const;

  std::vector<std::string> names_;
  std::unordered_map<std::string, int> places_;  ///< in names_
  std::map<std::string, FunctionExpansion> functions_;
};

/// What expressions may use, by name, and their values over a scalar S: double, or program::Symbol, which
/// writes the operations down. A number has the bits that a recorded program computes.
template <class S>
class NamedValues : public DefinedNames {
 public:
  /// Adds a name; returns its place. Throws std::invalid_argument if it exists already.
  int define(const std::string& name, const S& value = S(0.0)) {
    const int place = addName(name);
    values_.push_back(value);
    return place;
  }
  /// Gives a name, which may be new, a value.
  void set(const std::string& name, const S& value) {
    const int place = findPlace(name);
    place < 0 ? void(define(name, value)) : void(values_[place] = value);
  }
  const S& get(int place) const { return values_[place]; }
  const S& get(const std::string& name) const { return values_.at(findPlace(name)); }
  S& upd(int place) { return values_[place]; }

  /// The value; of numbers it may be inf or NaN (division by zero ...). `expression`: bound to these names,
  /// or a copy with more of them.
  S calc(const BoundExpression& expression) const {
    const auto& nodes = expression.nodes;
    if (nodes.size() == 1) {
      return getInput(nodes.front());
    }
    std::vector<S> results;
    results.reserve(nodes.size());
    for (const ExpressionTree::Node& node : nodes) {
      const auto operand = [&](int k) { return node.operands[k] < 0 ? S(0.0) : results[node.operands[k]]; };
      results.push_back(isInput(node) ? getInput(node)
                                      : apply(node.operation, operand(0), operand(1), operand(2)));
    }
    return results.back();
  }

  /// Throws as bind() does.
  S calc(const Expression& expression) const {
    double literal = 0.0;
    return parseLiteral(expression.text, literal) ? S(literal) : calc(bind(expression));
  }

  /// `missing` where the expression is not given.
  S calc(const Expression& expression, double missing) const {
    return expression.text.empty() ? S(missing) : calc(expression);
  }

  algebra::Vec3<S> calc3(const Expression3& expressions) const {
    return {calc(expressions[0]), calc(expressions[1]), calc(expressions[2])};
  }

 private:
  static bool isInput(const ExpressionTree::Node& node) {
    return node.operation == program::Operation::kLiteral || node.operation == program::Operation::kParameter;
  }
  S getInput(const ExpressionTree::Node& node) const {
    return node.operation == program::Operation::kLiteral ? S(node.literal) : values_[node.operands[0]];
  }

  std::vector<S> values_;
};

}  // namespace twinmap
