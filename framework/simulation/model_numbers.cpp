#include "framework/simulation/model_numbers.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "framework/experiment/model/curve.hpp"
#include "framework/experiment/model/parameter_box.hpp"

namespace twinmap {
namespace {

constexpr const char* kMustBeFinite = "must be finite";

void requireFinite(const Quantity& quantity, double value, const SourceLocation& where) {
  if (!std::isfinite(value)) {
    throwUnusable(quantity, value, kMustBeFinite, where);
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
    varying_.push_back(1);
  }
  for (const ConstantSpec& constant : model.constants) {
    constants_.push_back(values_.bind(constant.value));
    varying_.push_back(isVarying(constants_.back()) ? 1 : 0);
    defineName(values_, constant.name);
  }
  defineCurves(model.system.curves, values_);
}

void ModelNumbers::update(const Eigen::Ref<const Eigen::VectorXd>& point) {
  const int count = static_cast<int>(sampled_.size());
  for (int i = 0; i < count; ++i) {
    const ParameterSpec& parameter = sampled_[i];
    if (!std::isfinite(point[i])) {
      throwUnusable({"parameter", parameter.name.text.c_str(), parameter.unit.c_str()}, point[i],
                    kMustBeFinite, parameter.name.where);
    }
    values_.upd(i) = point[i];
  }
  for (int i = 0; i < static_cast<int>(constants_.size()); ++i) {
    if (knows_constants_ && varying_[count + i] == 0) {
      continue;
    }
    const ConstantSpec& constant = model_.constants[i];
    const double value = values_.calc(constants_[i]);
    requireFinite({"constant", constant.name.text.c_str(), constant.unit.c_str()}, value,
                  constant.value.where);
    values_.upd(count + i) = value;
  }
  knows_constants_ = true;
}

const BoundExpression& ModelNumbers::bind(const Expression& expression) {
  auto found = bound_.find(&expression);
  if (found == bound_.end()) {
    found = bound_.emplace(&expression, values_.bind(expression)).first;
  }
  return found->second;
}

bool ModelNumbers::isVarying(const BoundExpression& expression) const {
  return std::any_of(expression.nodes.begin(), expression.nodes.end(), [this](const auto& node) {
    return node.operation == program::Operation::kParameter && varying_[node.operands[0]] != 0;
  });
}

bool ModelNumbers::varies(const Expression& expression) {
  return isVarying(bind(expression));
}

bool ModelNumbers::isFinite(const Expression& expression) {
  return std::isfinite(values_.calc(bind(expression)));
}

std::vector<const Expression*> ModelNumbers::listUsed(const std::function<void()>& use) {
  used_.clear();
  lists_used_ = true;
  try {
    use();
  } catch (...) {
    lists_used_ = false;
    throw;
  }
  lists_used_ = false;
  return std::move(used_);
}

double ModelNumbers::calc(const Expression& expression, const Quantity& quantity) {
  if (lists_used_) {
    used_.push_back(&expression);
  }
  const double value = values_.calc(bind(expression));
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
