#include "framework/simulation/model_numbers.hpp"

#include <cmath>
#include <cstdio>

#include "framework/experiment/expression/curve.hpp"
#include "framework/experiment/model/parameter_box.hpp"

namespace twinmap {
namespace {

void requireFinite(const Quantity& quantity, double value, const SourceLocation& where) {
  if (!std::isfinite(value)) {
    throwUnusable(quantity, value, "must be finite", where);
  }
}

}  // namespace

void throwUnusable(const Quantity& quantity, double value, const std::string& rule,
                   const SourceLocation& where) {
  char number[32];
  std::snprintf(number, sizeof number, "%.9g", value);
  const std::string unit = *quantity.unit != '\0' ? std::string(" ") + quantity.unit : std::string();
  throw SimulationFailure(quantity.owner + ": " + quantity.name + " = " + number + unit + " " + rule, where);
}

ModelNumbers::ModelNumbers(const ModelSpec& model) : model_(model), sampled_(collectSampled(model)) {
  for (const ParameterSpec& parameter : sampled_) {
    defineName(values_, parameter.name);
  }
  for (const ConstantSpec& constant : model.constants) {
    constants_.push_back(values_.bind(constant.value));
    defineName(values_, constant.name);
  }
  defineCurves(model.system.curves, values_);
}

void ModelNumbers::update(const Eigen::Ref<const Eigen::VectorXd>& point) {
  const int count = static_cast<int>(sampled_.size());
  for (int i = 0; i < count; ++i) {
    const ParameterSpec& parameter = sampled_[i];
    requireFinite({"parameter", parameter.name.text.c_str(), parameter.unit.c_str()}, point[i],
                  parameter.name.where);
    values_.upd(i) = point[i];
  }
  for (std::size_t i = 0; i < constants_.size(); ++i) {
    const ConstantSpec& constant = model_.constants[i];
    const double value = values_.calc(constants_[i]);
    requireFinite({"constant", constant.name.text.c_str(), constant.unit.c_str()}, value,
                  constant.value.where);
    values_.upd(count + static_cast<int>(i)) = value;
  }
}

double ModelNumbers::calc(const Expression& expression, const Quantity& quantity) {
  auto found = bound_.find(&expression);
  if (found == bound_.end()) {
    found = bound_.emplace(&expression, values_.bind(expression)).first;
  }
  const double value = values_.calc(found->second);
  requireFinite(quantity, value, expression.where);
  return value;
}

double ModelNumbers::calcPositive(const Expression& expression, const Quantity& quantity) {
  const double value = calc(expression, quantity);
  if (value <= 0.0) {
    throwUnusable(quantity, value, "must be positive", expression.where);
  }
  return value;
}

std::array<double, 3> ModelNumbers::calc3(const Expression3& expressions, const Quantity& quantity) {
  return {calc(expressions[0], quantity), calc(expressions[1], quantity), calc(expressions[2], quantity)};
}

int defineName(NamedValues<double>& values, const Name& name) {
  if (values.contains(name.text) || isReservedName(name.text)) {
    throw ExperimentError(name.where, name.text, "is the name of something else already");
  }
  return values.define(name.text);
}

}  // namespace twinmap
