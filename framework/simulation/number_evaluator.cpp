#include "framework/simulation/number_evaluator.hpp"

#include <cmath>
#include <cstdio>

namespace twinmap {

void throwUnusable(const Quantity& quantity, double value, const std::string& rule,
                   const SourceLocation& where) {
  char number[32];
  std::snprintf(number, sizeof number, "%.9g", value);
  const std::string unit = *quantity.unit != '\0' ? std::string(" ") + quantity.unit : std::string();
  throw SimulationFailure(quantity.owner + ": " + quantity.name + " = " + number + unit + " " + rule, where);
}

double NumberEvaluator::calc(const Expression& expression, const Quantity& quantity) {
  auto found = compiled_.find(&expression);
  if (found == compiled_.end()) {
    found = compiled_.emplace(&expression, scope_.compile(expression)).first;
  }
  const double value = found->second.calc();
  if (!std::isfinite(value)) {
    throwUnusable(quantity, value, "must be finite", expression.where);
  }
  return value;
}

double NumberEvaluator::calcPositive(const Expression& expression, const Quantity& quantity) {
  const double value = calc(expression, quantity);
  if (value <= 0.0) {
    throwUnusable(quantity, value, "must be positive", expression.where);
  }
  return value;
}

std::array<double, 3> NumberEvaluator::calc3(const Expression3& expressions, const Quantity& quantity) {
  return {calc(expressions[0], quantity), calc(expressions[1], quantity), calc(expressions[2], quantity)};
}

std::vector<double> NumberEvaluator::calcEach(const std::vector<Expression>& expressions,
                                              const Quantity& quantity) {
  std::vector<double> values;
  values.reserve(expressions.size());
  for (const Expression& expression : expressions) {
    values.push_back(calc(expression, quantity));
  }
  return values;
}

}  // namespace twinmap
