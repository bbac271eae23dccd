#pragma once

#include <string>
#include <vector>

#include "framework/data/features/feature_extractor.hpp"
#include "framework/experiment/model/model_spec.hpp"
#include "framework/simulation/response_layout.hpp"

namespace twinmap::python {

/// What is told of a parameter, a feature, an input or an output.
struct Quantity {
  std::string name, unit, description;
  double lower, upper;  ///< bounds; NaN of what has none
};

std::vector<Quantity> describe(const std::vector<ParameterSpec>& parameters);
std::vector<Quantity> describe(const std::vector<FeatureInfo>& features);
std::vector<Quantity> describeOutputs(const ResponseLayout& layout);

}  // namespace twinmap::python
