#include "framework/experiment/check/uniform_priors.hpp"

#include <algorithm>

#include "framework/experiment/model/parameter_box.hpp"

namespace twinmap {

void requireUniformPriors(const ModelSpec& model, const char* rule) {
  const std::vector<ParameterSpec> unknown = collectUnknown(model);
  const auto stated = std::find_if(unknown.begin(), unknown.end(), [](const ParameterSpec& parameter) {
    return parameter.prior.has_value();
  });
  if (stated != unknown.end()) {
    throw ExperimentError(stated->name.where, stated->name.text, rule);
  }
  if (!model.priors.empty()) {
    throw ExperimentError(model.priors.front().where, "priors", rule);
  }
}

}  // namespace twinmap
