#include "framework/models/mechanism/simbody/state_expressions.hpp"

namespace twinmap {
namespace {

/// Compiles the fields of a description that vary (fields/fields.hpp).
class VaryingFields {
 public:
  VaryingFields(ExpressionScope& scope, std::unordered_map<const Expression*, CompiledExpression>& compiled)
      : scope_(scope), compiled_(compiled) {}

  template <class T, class... Rule>
  void required(const char*, T&, const char*, const Rule&...) {}
  void required(const char*, Expression& field, const char*, const Unit& unit) {
    if (unit.varies) {
      compile(field);
    }
  }
  void required(const char*, Expression3& field, const char*, const Unit& unit) {
    for (const Expression& component : field) {
      if (unit.varies) {
        compile(component);
      }
    }
  }
  template <class T, class... Rule>
  void optional(const char* key, T& field, const char* what, const Rule&... rule) {
    required(key, field, what, rule...);
  }
  void rule(bool, const char*) const {}

 private:
  void compile(const Expression& expression) { compiled_.emplace(&expression, scope_.compile(expression)); }

  ExpressionScope& scope_;
  std::unordered_map<const Expression*, CompiledExpression>& compiled_;
};

}  // namespace

StateExpressions::StateExpressions(const ModelSpec& model, const ExpressionScope& numbers) {
  defineNames(model, numbers);
  VaryingFields fields(scope_, compiled_);
  const_cast<ForceElements<Expression>&>(model.system.elements).forEachList([&fields](auto& list) {
    for (auto& element : list) {
      describe(fields, element);  // which reads them only
    }
  });
}

void StateExpressions::defineNames(const ModelSpec& model, const ExpressionScope& numbers) {
  const auto getCount = [this] { return static_cast<int>(scope_.getNames().size()); };
  for (const std::string& name : numbers.getNames()) {
    scope_.define(name);
  }
  first_coordinate_ = getCount();
  for (const BodySpec& body : model.system.bodies) {
    for (const Name& coordinate : body.joint.coordinates) {
      defineName(scope_, coordinate);
    }
  }
  first_speed_ = getCount();
  for (const BodySpec& body : model.system.bodies) {
    for (const Name& coordinate : body.joint.coordinates) {
      defineName(scope_, {coordinate.text + "_dot", coordinate.where});
    }
  }
  first_signal_ = getCount();
  for (const SignalSpec& signal : model.excitation) {
    defineName(scope_, signal.name);
  }
  time_ = scope_.define("t");
}

void StateExpressions::setNumbers(const ExpressionScope& values) {
  for (int i = 0; i < first_coordinate_; ++i) {
    scope_.upd(i) = values.get(i);
  }
}

void StateExpressions::setFrom(int first, const std::vector<double>& values) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    scope_.upd(first + static_cast<int>(i)) = values[i];
  }
}

void StateExpressions::setState(double t, const std::vector<double>& coordinates,
                                const std::vector<double>& rates, const std::vector<double>& signals) {
  if (compiled_.empty()) {
    return;
  }
  setFrom(first_coordinate_, coordinates);
  setFrom(first_speed_, rates);
  setFrom(first_signal_, signals);
  scope_.upd(time_) = t;
}

}  // namespace twinmap
