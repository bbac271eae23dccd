#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>
#include <unordered_map>
#include <vector>

#include "framework/experiment/expression/named_values.hpp"
#include "framework/experiment/model/model_spec.hpp"
#include "framework/simulation/simulation_failure.hpp"

namespace twinmap {

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

  /// Whether a parameter changes the value of an expression of the model.
  bool varies(const Expression& expression);
  /// Whether the value of an expression of the model is finite.
  bool isFinite(const Expression& expression);
  /// The expressions whose values `use` asks for.
  std::vector<const Expression*> listUsed(const std::function<void()>& use);

  /// The value of an expression of the model, checked to be finite (else SimulationFailure). Throws
  /// ExperimentError at the first use of an expression that is wrong. About 30 ns for a literal.
  double calc(const Expression& expression, const Quantity& quantity);
  double calcPositive(const Expression& expression, const Quantity& quantity);
  std::array<double, 3> calc3(const Expression3& expressions, const Quantity& quantity);

 private:
  const BoundExpression& bind(const Expression& expression);
  bool isVarying(const BoundExpression& expression) const;

  const ModelSpec& model_;
  std::vector<ParameterSpec> sampled_;
  NamedValues<double> values_;
  std::vector<BoundExpression> constants_;
  std::vector<char> varying_;  ///< by place of the values: parameters, and constants that follow from them
  std::vector<const Expression*> used_;
  bool lists_used_ = false;
  bool knows_constants_ = false;  ///< those that do not vary
  std::unordered_map<const Expression*, BoundExpression> bound_;
};

/// Defines `name` in `values`. Throws ExperimentError if it exists already or is reserved.
int defineName(NamedValues<double>& values, const Name& name);

}  // namespace twinmap
