#include "framework/models/mechanism/simbody/state_expressions.hpp"

#include "framework/models/mechanism/equations/outputs.hpp"
#include "framework/models/mechanism/system_names.hpp"
#include "framework/models/mechanism/varying_expressions.hpp"

namespace twinmap {
namespace {

constexpr int kTaken = -1;  ///< another value has the name

}  // namespace

StateExpressions::StateExpressions(const ModelSpec& model, const NamedValues<double>& numbers) {
  defineNames(model, numbers);
  defineStates(model);
  const ExpressionAction bind = [this](const Expression& expression) {
    bound_.emplace(&expression, values_.bind(expression));
  };
  forEachForceExpression(model.system, bind);
  first_acceleration_ = static_cast<int>(values_.getNames().size());
  if (equations::hasExpression(model.outputs)) {
    defineAccelerations(model);
    forEachOutputExpression(model.outputs, bind);
  }
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

void StateExpressions::defineAccelerations(const ModelSpec& model) {
  for (const BodySpec& body : model.system.bodies) {
    for (const Name& coordinate : body.joint.coordinates) {
      defineName(values_, {coordinate.text + "_ddot", coordinate.where});
    }
  }
}

void StateExpressions::defineNames(const ModelSpec& model, const NamedValues<double>& numbers) {
  const auto getCount = [this] { return static_cast<int>(values_.getNames().size()); };
  for (const std::string& name : numbers.getNames()) {
    values_.define(name);
  }
  values_.takeFunctions(numbers);
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
  for (const std::string& rate : nameSignalRates(model.excitation, countSignalRates(model))) {
    signal_rates_.push_back(values_.contains(rate) ? kTaken : values_.define(rate));
  }
  if (mayUseGravity(model)) {
    defineGravity(model);
  }
}

void StateExpressions::defineGravity(const ModelSpec& model) {
  const SystemNames names(model.system);
  for (const std::string& coordinate : names.getCoordinateNames()) {
    const std::string name = coordinate + kGravitySuffix;
    const bool is_taken = values_.contains(name) || isOwnName(model.system, name);
    gravity_.push_back(is_taken ? kTaken : values_.define(name));
  }
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

void StateExpressions::setAt(const std::vector<int>& places, const std::vector<double>& values) {
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (places[i] != kTaken) {
      values_.upd(places[i]) = values[i];
    }
  }
}

void StateExpressions::setState(double t, const std::vector<double>& coordinates,
                                const std::vector<double>& rates, const std::vector<double>& gravity,
                                const std::vector<double>& states, const std::vector<double>& signals,
                                const std::vector<double>& signal_rates) {
  if (bound_.empty()) {
    return;
  }
  setFrom(first_coordinate_, coordinates);
  setFrom(first_speed_, rates);
  setFrom(first_signal_, signals);
  values_.upd(time_) = t;
  setAt(gravity_, gravity);
  setAt(signal_rates_, signal_rates);
  setFrom(first_state_, states);
  for (std::size_t i = 0; i < named_.size(); ++i) {
    values_.upd(first_named_ + static_cast<int>(i)) = values_.calc(named_[i]);
  }
}

void StateExpressions::setAccelerations(const std::vector<double>& accelerations) {
  setFrom(first_acceleration_, accelerations);
}

}  // namespace twinmap
