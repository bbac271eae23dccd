#pragma once

#include <array>
#include <stdexcept>
#include <string>
#include <unordered_map>
#include <vector>

#include "framework/experiment/expression/expression.hpp"

namespace twinmap {

/// Why one sample cannot be simulated: "body 'beam1': mass = 0 kg must be positive". Thrown while a sample is
/// prepared or run; a simulator turns it into that sample's status.
class SimulationFailure : public std::runtime_error {
 public:
  /// `where`: the number of the experiment that is the cause, where it is known.
  explicit SimulationFailure(const std::string& reason, SourceLocation where = {})
      : std::runtime_error(reason), where_(std::move(where)) {}

  const SourceLocation& getWhere() const { return where_; }

 private:
  SourceLocation where_;
};

/// How messages call a number: "<owner>: <name> = 0 <unit>".
struct Quantity {
  const std::string& owner;  ///< "body 'beam1'"
  const char* name;          ///< "mass"
  const char* unit;          ///< "kg"
};

/// Throws SimulationFailure("<owner>: <name> = <value> <unit> <rule>"); `where` the value is given.
[[noreturn]] void throwUnusable(const Quantity& quantity, double value, const std::string& rule,
                                const SourceLocation& where);

/// Evaluates the numbers of a spec at the current values of a scope. Each expression is compiled at its first
/// use and remembered by its address, so the spec must outlive the evaluator unchanged. Not thread safe.
class NumberEvaluator {
 public:
  explicit NumberEvaluator(ExpressionScope& scope) : scope_(scope) {}

  /// The value, checked to be finite (else SimulationFailure). Throws ExperimentError at the first use of an
  /// expression that does not compile. About 30 ns for a literal.
  double calc(const Expression& expression, const Quantity& quantity);
  double calcPositive(const Expression& expression, const Quantity& quantity);
  std::array<double, 3> calc3(const Expression3& expressions, const Quantity& quantity);
  std::vector<double> calcEach(const std::vector<Expression>& expressions, const Quantity& quantity);

 private:
  ExpressionScope& scope_;
  std::unordered_map<const Expression*, CompiledExpression> compiled_;
};

}  // namespace twinmap
