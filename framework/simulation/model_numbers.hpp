#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/experiment/model/model_spec.hpp"
#include "framework/simulation/number_evaluator.hpp"

namespace twinmap {

/// The parameters and constants of a model as named values, and the numbers that follow from them.
class ModelNumbers {
 public:
  /// `model` must outlive the object unchanged. Throws ExperimentError for a name declared twice or a
  /// constant that does not compile.
  explicit ModelNumbers(const ModelSpec& model);

  /// Sets the parameters to a point of the sampled box (collectSampled) and computes the constants. Throws
  /// SimulationFailure for a value that is not finite.
  void update(const Eigen::Ref<const Eigen::VectorXd>& point);

  const ExpressionScope& getScope() const { return scope_; }
  NumberEvaluator& updNumbers() { return numbers_; }

 private:
  const ModelSpec& model_;
  std::vector<ParameterSpec> sampled_;
  ExpressionScope scope_;
  NumberEvaluator numbers_{scope_};
  std::vector<CompiledExpression> constants_;
};

/// Defines `name` in `scope`. Throws ExperimentError if it exists already or is reserved.
int defineName(ExpressionScope& scope, const Name& name);

}  // namespace twinmap
