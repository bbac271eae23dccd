#include "framework/multibody/model_numbers.hpp"

#include <cmath>

namespace twinmap {
namespace {

void checkFinite(const char* kind, const Name& name, const std::string& unit, double value) {
  if (!std::isfinite(value)) {
    throwUnusable({kind, name.text.c_str(), unit.c_str()}, value, "must be finite");
  }
}

}  // namespace

ModelNumbers::ModelNumbers(const ModelSpec& model) : model_(model) {
  for (const ParameterSpec& parameter : model.parameters) {
    defineName(scope_, parameter.name);
  }
  for (const ConstantSpec& constant : model.constants) {
    constants_.push_back(scope_.compile(constant.value));
    defineName(scope_, constant.name);
  }
}

void ModelNumbers::update(const Eigen::Ref<const Eigen::VectorXd>& parameters) {
  const int count = static_cast<int>(model_.parameters.size());
  for (int i = 0; i < count; ++i) {
    const ParameterSpec& spec = model_.parameters[i];
    checkFinite("parameter", spec.name, spec.unit, parameters[i]);
    scope_.upd(i) = parameters[i];
  }
  for (std::size_t i = 0; i < constants_.size(); ++i) {
    const double value = constants_[i].calc();
    checkFinite("constant", model_.constants[i].name, model_.constants[i].unit, value);
    scope_.upd(count + static_cast<int>(i)) = value;
  }
}

int defineName(ExpressionScope& scope, const Name& name) {
  if (scope.contains(name.text) || isReservedName(name.text)) {
    throw ExperimentError(name.where, name.text, "is the name of something else already");
  }
  return scope.define(name.text);
}

}  // namespace twinmap
