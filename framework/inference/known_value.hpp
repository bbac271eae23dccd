#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "framework/experiment/model/model_spec.hpp"

namespace twinmap {

/// "NAME=VALUE", the value of a known input.
struct KnownValue {
  std::string name;
  double value = 0.0;
};

/// option: which gives it. Throws ExperimentError for a text of another form.
KnownValue parseKnownValue(const std::string& text, const std::string& option = "--set");

/// Each of the texts.
std::vector<KnownValue> parseKnownValues(const std::vector<std::string>& texts,
                                         const std::string& option = "--set");

/// The values of all inputs of a model, in their order and units. Throws ExperimentError for an input that is
/// missing, given twice or outside its bounds, and for a name that is not an input.
Eigen::VectorXd collectKnown(const std::vector<ParameterSpec>& inputs, const std::vector<KnownValue>& values);

}  // namespace twinmap
