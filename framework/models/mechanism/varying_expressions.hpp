#pragma once

#include <algorithm>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "framework/experiment/model/elements/force_elements.hpp"
#include "framework/experiment/model/gravity_name.hpp"
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
  void required(const char*, std::optional<T>& field, const char*, const Rule&...) {
    if constexpr (kIsPart<T>) {
      if (field) {
        describe(*this, *field);
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

/// The names that expressions of forces, states and outputs use, and those of named expressions.
inline std::vector<std::string> listUsedNames(const ModelSpec& model) {
  std::vector<std::string> used;
  const ExpressionAction look = [&](const Expression& expression) {
    const std::vector<std::string> names = getUsedNames(expression);
    used.insert(used.end(), names.begin(), names.end());
  };
  forEachForceExpression(model.system, look);
  forEachOutputExpression(model.outputs, look);
  for (const NamedExpression& named : model.system.expressions) {
    look(named.value);
  }
  return used;
}

/// Whether an expression may use the force of gravity on a coordinate (<coordinate>_gravity), which is
/// computed for these alone.
inline bool mayUseGravity(const ModelSpec& model) {
  bool may = false;
  const ExpressionAction look = [&may](const Expression& expression) {
    may = may || expression.text.find(kGravitySuffix) != std::string::npos;
  };
  forEachForceExpression(model.system, look);
  forEachOutputExpression(model.outputs, look);
  for (const NamedExpression& named : model.system.expressions) {
    look(named.value);
  }
  return may;
}

/// Whether a state or a named expression is called so.
inline bool isOwnName(const SystemSpec& system, const std::string& name) {
  const auto has = [&](const auto& items) {
    return std::any_of(items.begin(), items.end(), [&](const auto& item) { return item.name.text == name; });
  };
  return has(system.states) || has(system.expressions);
}

/// In expressions, of all signals those of their rates (<signal>_dot), then, for two orders, of the rates of
/// these (<signal>_ddot).
inline std::vector<std::string> nameSignalRates(const std::vector<SignalSpec>& signals, int orders) {
  std::vector<std::string> names;
  for (int order = 1; order <= orders; ++order) {
    for (const SignalSpec& signal : signals) {
      names.push_back(signal.name.text + (order == 1 ? "_dot" : "_ddot"));
    }
  }
  return names;
}

/// How many orders of time derivatives of signals expressions use, 0 to 2: only those are computed. What a
/// state or a named expression is called is theirs.
inline int countSignalRates(const ModelSpec& model) {
  const std::vector<std::string> used = listUsedNames(model);
  const std::vector<std::string> names = nameSignalRates(model.excitation, 2);
  int orders = 0;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const bool uses =
        std::find(used.begin(), used.end(), names[i]) != used.end() && !isOwnName(model.system, names[i]);
    orders = uses ? std::max(orders, i < model.excitation.size() ? 1 : 2) : orders;
  }
  return orders;
}

}  // namespace twinmap
