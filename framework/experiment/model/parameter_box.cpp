#include "framework/experiment/model/parameter_box.hpp"

namespace twinmap {
namespace {

void appendParameters(const std::vector<ParameterSpec>& more, std::vector<ParameterSpec>& all) {
  all.insert(all.end(), more.begin(), more.end());
}

}  // namespace

std::vector<ParameterSpec> collectUnknown(const ModelSpec& model) {
  std::vector<ParameterSpec> unknown = model.parameters;
  appendParameters(model.nuisance, unknown);
  return unknown;
}

std::vector<ParameterSpec> collectSampled(const ModelSpec& model) {
  std::vector<ParameterSpec> sampled = collectUnknown(model);
  appendParameters(model.inputs, sampled);
  return sampled;
}

Eigen::Index countSampled(const ModelSpec& model) {
  return static_cast<Eigen::Index>(model.parameters.size() + model.nuisance.size() + model.inputs.size());
}

}  // namespace twinmap
