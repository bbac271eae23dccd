#include "framework/models/mechanism/simbody/state_expressions.hpp"

#include "framework/models/mechanism/equations/outputs.hpp"
#include "framework/models/mechanism/system_names.hpp"

namespace twinmap {
namespace {

/// Binds the fields of a description that vary (fields/fields.hpp).
class VaryingFields {
 public:
  VaryingFields(NamedValues<double>& values, std::unordered_map<const Expression*, BoundExpression>& bound)
      : values_(values), bound_(bound) {}

  template <class T, class... Rule>
  void required(const char*, T&, const char*, const Rule&...) {}
  void required(const char*, Expression& field, const char*, const Unit& unit) {
    if (unit.varies) {
      bind(field);
    }
  }
  void required(const char*, Expression3& field, const char*, const Unit& unit) {
    for (const Expression& component : field) {
      if (unit.varies) {
        bind(component);
      }
    }
  }
  template <class T, class... Rule>
  void optional(const char* key, T& field, const char* what, const Rule&... rule) {
    required(key, field, what, rule...);
  }
  void rule(bool, const char*) const {}

 private:
  void bind(const Expression& expression) { bound_.emplace(&expression, values_.bind(expression)); }

  NamedValues<double>& values_;
  std::unordered_map<const Expression*, BoundExpression>& bound_;
};

}  // namespace

StateExpressions::StateExpressions(const ModelSpec& model, const NamedValues<double>& numbers) {
  defineNames(model, numbers);
  defineStates(model);
  for (const StateSpec& state : model.system.states) {
    bound_.emplace(&state.derivative, values_.bind(state.derivative));
  }
  VaryingFields fields(values_, bound_);
  const_cast<ForceElements<Expression>&>(model.system.elements).forEachList([&fields](auto& list) {
    for (auto& element : list) {
      describe(fields, element);  // which reads them only
    }
  });
  bindOutputs(model);
}

void StateExpressions::defineStates(const ModelSpec& model) {
  first_state_ = static_cast<int>(values_.getNames().size());
  const SystemNames names(model.system);
  for (const std::string& state : names.getStateNames()) {
    defineName(values_, {state, {}});
  }
  first_named_ = static_cast<int>(values_.getNames().size());
  for (const NamedExpression& named : model.system.expressions) {
    named_.push_back(values_.bind(named.value));
    defineName(values_, named.name);
  }
}

void StateExpressions::bindOutputs(const ModelSpec& model) {
  first_acceleration_ = static_cast<int>(values_.getNames().size());
  if (!equations::hasExpression(model.outputs)) {
    return;
  }
  for (const BodySpec& body : model.system.bodies) {
    for (const Name& coordinate : body.joint.coordinates) {
      defineName(values_, {coordinate.text + "_ddot", coordinate.where});
    }
  }
  for (const OutputSpec& output : model.outputs) {
    if (!output.expression.text.empty()) {
      bound_.emplace(&output.expression, values_.bind(output.expression));
    }
  }
}

void StateExpressions::defineNames(const ModelSpec& model, const NamedValues<double>& numbers) {
  const auto getCount = [this] { return static_cast<int>(values_.getNames().size()); };
  for (const std::string& name : numbers.getNames()) {
    values_.define(name);
  }
  first_coordinate_ = getCount();
  for (const BodySpec& body : model.system.bodies) {
    for (const Name& coordinate : body.joint.coordinates) {
      defineName(values_, coordinate);
    }
  }
  first_speed_ = getCount();
  for (const BodySpec& body : model.system.bodies) {
    for (const Name& coordinate : body.joint.coordinates) {
      defineName(values_, {coordinate.text + "_dot", coordinate.where});
    }
  }
  first_signal_ = getCount();
  for (const SignalSpec& signal : model.excitation) {
    defineName(values_, signal.name);
  }
  time_ = values_.define("t");
}

void StateExpressions::setNumbers(const NamedValues<double>& values) {
  for (int i = 0; i < first_coordinate_; ++i) {
    values_.upd(i) = values.get(i);
  }
}

void StateExpressions::setFrom(int first, const std::vector<double>& values) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    values_.upd(first + static_cast<int>(i)) = values[i];
  }
}

void StateExpressions::setState(double t, const std::vector<double>& coordinates,
                                const std::vector<double>& rates, const std::vector<double>& states,
                                const std::vector<double>& signals) {
  if (bound_.empty()) {
    return;
  }
  setFrom(first_coordinate_, coordinates);
  setFrom(first_speed_, rates);
  setFrom(first_signal_, signals);
  values_.upd(time_) = t;
  setFrom(first_state_, states);
  for (std::size_t i = 0; i < named_.size(); ++i) {
    values_.upd(first_named_ + static_cast<int>(i)) = values_.calc(named_[i]);
  }
}

void StateExpressions::setAccelerations(const std::vector<double>& accelerations) {
  setFrom(first_acceleration_, accelerations);
}

}  // namespace twinmap
