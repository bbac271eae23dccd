#pragma once

#include <string>
#include <unordered_map>
#include <vector>

#include "framework/base/text/number_text.hpp"
#include "framework/experiment/expression/expression.hpp"
#include "framework/experiment/model/algebra.hpp"
#include "framework/models/mechanism/equations/calc_expression.hpp"

namespace twinmap::equations {

/// What the expressions of a model may use, by name, and their values over a scalar.
template <class S>
class NamedValues {
 public:
  void set(const std::string& name, const S& value) { values_.insert_or_assign(name, value); }
  const S& get(const std::string& name) const { return values_.at(name); }

  /// Throws UnknownSyntax; names must be known (an ExpressionScope has compiled the expression before).
  S calc(const Expression& expression) const {
    double literal = 0.0;
    if (parseLiteral(expression.text, literal)) {
      return S(literal);
    }
    const ExpressionTree tree = parseExpression(expression.text);
    std::vector<S> used;
    for (const std::string& name : tree.names) {
      used.push_back(get(name));
    }
    return calcExpression(tree, used);
  }

  /// `missing` where the expression is not given.
  S calc(const Expression& expression, double missing) const {
    return expression.text.empty() ? S(missing) : calc(expression);
  }

  algebra::Vec3<S> calc3(const Expression3& expressions) const {
    return {calc(expressions[0]), calc(expressions[1]), calc(expressions[2])};
  }

  std::vector<S> calcEach(const std::vector<Expression>& expressions) const {
    std::vector<S> values;
    for (const Expression& expression : expressions) {
      values.push_back(calc(expression));
    }
    return values;
  }

 private:
  std::unordered_map<std::string, S> values_;
};

}  // namespace twinmap::equations
