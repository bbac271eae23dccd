#include "framework/simulation/model_numbers.hpp"

#include <cmath>

#include "framework/experiment/model/parameter_box.hpp"

namespace twinmap {
namespace {

void checkFinite(const char* kind, const Name& name, const std::string& unit, double value,
                 const SourceLocation& where) {
  if (!std::isfinite(value)) {
    throwUnusable({kind, name.text.c_str(), unit.c_str()}, value, "must be finite", where);
  }
}

}  // namespace

ModelNumbers::ModelNumbers(const ModelSpec& model) : model_(model), sampled_(collectSampled(model)) {
  for (const ParameterSpec& parameter : sampled_) {
    defineName(scope_, parameter.name);
  }
  for (const ConstantSpec& constant : model.constants) {
    constants_.push_back(scope_.compile(constant.value));
    defineName(scope_, constant.name);
  }
}

void ModelNumbers::update(const Eigen::Ref<const Eigen::VectorXd>& point) {
  const int count = static_cast<int>(sampled_.size());
  for (int i = 0; i < count; ++i) {
    checkFinite("parameter", sampled_[i].name, sampled_[i].unit, point[i], sampled_[i].name.where);
    scope_.upd(i) = point[i];
  }
  for (std::size_t i = 0; i < constants_.size(); ++i) {
    const double value = constants_[i].calc();
    const ConstantSpec& constant = model_.constants[i];
    checkFinite("constant", constant.name, constant.unit, value, constant.value.where);
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
