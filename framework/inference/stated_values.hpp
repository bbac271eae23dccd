#pragma once

#include <string>
#include <vector>

#include "framework/inference/derived_values.hpp"
#include "framework/inference/inferrer.hpp"

namespace twinmap {

/// All that is said of a measurement in numbers: of parameters, of what follows from them, of nuisance.
struct StatedValues {
  /// What is believed (selectEstimate) or, where nothing is, what is determined all the same
  /// (PosteriorEstimate::determined).
  Estimate estimate;
  /// Of the experiment's quantities, and of the combinations that alone are determined (listDerived), named
  /// by their expressions. NaN of those that are not determined.
  std::vector<DerivedValue> derived, identified;
  std::vector<DerivedValue> nuisance;
};

/// Whether anything is known of a parameter.
bool isStated(const Estimate& estimate, Eigen::Index parameter);

StatedValues stateValues(const InferredMeasurement& inferred, const Estimate& believed,
                         const std::vector<ParameterSpec>& parameters);

}  // namespace twinmap
