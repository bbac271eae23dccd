#pragma once

#include <Eigen/Core>
#include <array>
#include <unordered_map>
#include <vector>

#include "framework/experiment/expression/named_values.hpp"
#include "framework/experiment/model/model_spec.hpp"
#include "framework/simulation/simulation_failure.hpp"

namespace twinmap {

/// Former names, until mechanisms use the new ones.
struct CompiledExpression {
  const NamedValues<double>* values;
  BoundExpression expression;

  double calc() const { return values->calc(expression); }
};
class ExpressionScope : public NamedValues<double> {
 public:
  CompiledExpression compile(const Expression& expression) const { return {this, bind(expression)}; }
};
class UnknownSyntax : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The parameters and constants of a model as named values, and the numbers that follow from them. Each
/// expression is bound at its first use and remembered by its address. Not thread safe.
class ModelNumbers {
 public:
  /// `model` must outlive the object unchanged. Throws ExperimentError for a name declared twice or a
  /// constant that does not compile.
  explicit ModelNumbers(const ModelSpec& model);

  /// Sets the parameters to a point of the sampled box (collectSampled) and computes the constants. Throws
  /// SimulationFailure for a value that is not finite.
  void update(const Eigen::Ref<const Eigen::VectorXd>& point);

  const NamedValues<double>& getValues() const { return values_; }
  const ExpressionScope& getScope() const { return values_; }
  ModelNumbers& updNumbers() { return *this; }

  /// The value of an expression of the model, checked to be finite (else SimulationFailure). Throws
  /// ExperimentError at the first use of an expression that is wrong. About 30 ns for a literal.
  double calc(const Expression& expression, const Quantity& quantity);
  double calcPositive(const Expression& expression, const Quantity& quantity);
  std::array<double, 3> calc3(const Expression3& expressions, const Quantity& quantity);

 private:
  const ModelSpec& model_;
  std::vector<ParameterSpec> sampled_;
  ExpressionScope values_;
  std::vector<BoundExpression> constants_;
  std::unordered_map<const Expression*, BoundExpression> bound_;
};

/// Defines `name` in `values`. Throws ExperimentError if it exists already or is reserved.
int defineName(NamedValues<double>& values, const Name& name);

}  // namespace twinmap
