#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/models/mechanism/model_context.hpp"

namespace twinmap {

/// checkNumbers() for many parameter sets: once for what no parameter changes, and of values that must be
/// finite and no more, only whether they are. Not thread safe.
class NumberChecks {
 public:
  /// Checks all at the centre of the bounds, which it makes the context's parameter set. `context` must
  /// outlive the checks. Throws as ModelNumbers::update() and checkNumbers() do.
  explicit NumberChecks(ModelContext& context);

  /// Makes `point` the context's parameter set. Throws what checkNumbers() throws there. Cost: some 20 ns a
  /// parameter where forces and initial values alone use them; some microseconds for each body and output
  /// that does.
  void check(const Eigen::Ref<const Eigen::VectorXd>& point);

  /// With the numbers of the parameter set checked last.
  ModelContext& updContext() { return context_; }

 private:
  struct VaryingCheck {
    NumberCheck all;
    std::vector<const Expression*> expressions;  ///< those that a parameter changes
  };
  bool areFinite(const VaryingCheck& varying);

  ModelContext& context_;
  std::vector<VaryingCheck> varying_;
};

}  // namespace twinmap
