#pragma once

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include "framework/experiment/model/model_spec.hpp"

namespace twinmap {

/// What is done with an expression of a model that may use its state.
using ExpressionAction = std::function<void(const Expression&)>;

/// Visits the fields of a description that vary (fields/fields.hpp).
class VaryingFields {
 public:
  explicit VaryingFields(const ExpressionAction& action) : action_(action) {}

  template <class T, class... Rule>
  void required(const char*, T&, const char*, const Rule&...) {}
  void required(const char*, Expression& field, const char*, const Unit& unit) {
    if (unit.varies) {
      action_(field);
    }
  }
  void required(const char*, Expression3& field, const char*, const Unit& unit) {
    for (const Expression& component : field) {
      if (unit.varies) {
        action_(component);
      }
    }
  }
  template <class T, class... Rule>
  void optional(const char* key, T& field, const char* what, const Rule&... rule) {
    required(key, field, what, rule...);
  }
  void rule(bool, const char*) const {}

 private:
  const ExpressionAction& action_;
};

/// Of force elements and states: what forces and rates are made of. Named expressions stand behind them.
inline void forEachForceExpression(const SystemSpec& system, const ExpressionAction& action) {
  for (const StateSpec& state : system.states) {
    action(state.derivative);
  }
  VaryingFields fields(action);
  const_cast<ForceElements<Expression>&>(system.elements).forEachList([&fields](auto& list) {
    for (auto& element : list) {
      describe(fields, element);  // which reads them only
    }
  });
}

inline void forEachOutputExpression(const std::vector<OutputSpec>& outputs, const ExpressionAction& action) {
  for (const OutputSpec& output : outputs) {
    if (!output.expression.text.empty()) {
      action(output.expression);
    }
  }
}

/// The name of a signal's rate in expressions.
inline std::string nameRate(const SignalSpec& signal) {
  return signal.name.text + "_dot";
}

/// Whether any expression uses the rate of a signal: only then is it computed.
inline bool usesSignalRates(const ModelSpec& model) {
  bool uses = false;
  const ExpressionAction look = [&](const Expression& expression) {
    const std::vector<std::string> names = getUsedNames(expression);
    for (const SignalSpec& signal : model.excitation) {
      uses = uses || std::find(names.begin(), names.end(), nameRate(signal)) != names.end();
    }
  };
  forEachForceExpression(model.system, look);
  forEachOutputExpression(model.outputs, look);
  for (const NamedExpression& named : model.system.expressions) {
    look(named.value);
  }
  return uses;
}

}  // namespace twinmap
