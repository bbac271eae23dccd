#include <algorithm>

#include "framework/experiment/check/check_experiment.hpp"
#include "framework/experiment/check/check_scope.hpp"
#include "framework/experiment/check/known_names.hpp"
#include "framework/experiment/model/parameter_box.hpp"

namespace twinmap {
namespace {

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// Declares what derived quantities may use, and remembers why other names cannot be used.
class DerivedCheck {
 public:
  explicit DerivedCheck(const ExperimentSpec& experiment) : experiment_(experiment) {
    for (const ParameterSpec& parameter : experiment.model.parameters) {
      scope_.define(parameter.name, CheckScope::readUnit(parameter.unit, parameter.name.where),
                    0.5 * (parameter.bounds.lower + parameter.bounds.upper));
    }
    for (const ConstantSpec& constant : experiment.model.constants) {
      if (followsFromParameters(constant.value)) {
        const double value = scope_.check(constant.value, constant.unit);
        scope_.define(constant.name, CheckScope::readUnit(constant.unit, constant.name.where), value);
      }
    }
  }

  /// Those that follow from updating parameters.
  void declareCurves() {
    for (const CurveSpec& curve : experiment_.model.system.curves) {
      const bool follows =
          std::all_of(curve.values.begin(), curve.values.end(),
                      [this](const Expression& value) { return followsFromParameters(value); });
      if (follows) {
        scope_.defineCurve(curve.name, {}, CheckScope::readUnit(curve.unit, curve.name.where));
      }
    }
  }

  void check(const DerivedSpec& derived) {
    requireUntaken(derived.name);
    for (const std::string& used : getUsedNames(derived.value)) {
      requireUsable(used, derived.value);
    }
    const std::optional<Dimension> dimension = CheckScope::readUnit(derived.unit, derived.name.where);
    scope_.define(derived.name, dimension, scope_.check(derived.value, derived.unit));
  }

 private:
  bool followsFromParameters(const Expression& expression) const {
    const std::vector<std::string> used = getUsedNames(expression);
    return std::all_of(used.begin(), used.end(),
                       [&](const std::string& name) { return contains(scope_.getNames(), name); });
  }

  /// Names of the model that no derived quantity can use are taken all the same.
  void requireUntaken(const Name& name) const {
    const ModelSpec& model = experiment_.model;
    if (contains(collectNames(collectSampled(model)), name.text) ||
        contains(collectNames(model.constants), name.text)) {
      throw ExperimentError(name.where, name.text,
                            "is taken; derived quantities share the name space of parameters, nuisance, "
                            "inputs and constants");
    }
  }

  void requireUsable(const std::string& used, const Expression& expression) const {
    if (contains(scope_.getNames(), used)) {
      return;
    }
    const ModelSpec& model = experiment_.model;
    const auto refuse = [&](const std::string& why) {
      throw ExperimentError(expression.where, expression.text, "uses '" + used + "', " + why);
    };
    if (contains(collectNames(experiment_.derived), used)) {
      refuse("which is not derived before it; order them so that none needs itself or a later one");
    }
    if (contains(collectNames(model.nuisance), used)) {
      refuse("a nuisance parameter, which is not inferred; make it one of parameters");
    }
    if (contains(collectNames(model.inputs), used)) {
      refuse("an input; derived quantities follow from the updating parameters alone");
    }
    if (contains(collectNames(model.constants), used)) {
      refuse("a constant that depends on nuisance parameters or inputs, not on updating parameters alone");
    }
  }

  const ExperimentSpec& experiment_;
  CheckScope scope_;
};

}  // namespace

void checkDerived(const ExperimentSpec& experiment) {
  if (experiment.derived.empty()) {
    return;
  }
  DerivedCheck check(experiment);
  check.declareCurves();
  for (const DerivedSpec& derived : experiment.derived) {
    check.check(derived);
  }
}

}  // namespace twinmap
