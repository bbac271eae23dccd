#pragma once

#include <optional>
#include <vector>

#include "framework/experiment/expression/expression.hpp"
#include "framework/experiment/fields/fields.hpp"

namespace twinmap {

/// Values by name, in file order (initial coordinates, reference parameters ...).
struct NamedExpression {
  Name name;
  Expression value;
};

template <class Fields>
void describe(Fields& f, NamedExpression& s) {
  f.value(s.value);
}

enum class EquilibriumAt { kBoxCenter, kSample };

template <>
struct EnumNames<EquilibriumAt> {
  static constexpr EnumName<EquilibriumAt> values[] = {{"box_center", EquilibriumAt::kBoxCenter},
                                                       {"sample", EquilibriumAt::kSample}};
};

/// Start at rest where all accelerations vanish, without excitation.
struct EquilibriumSpec {
  EquilibriumAt at = EquilibriumAt::kBoxCenter;  ///< one equilibrium for all samples, or each sample its own
  std::vector<NamedExpression> parameters;       ///< with kBoxCenter: values that replace the centre's
};

template <class Fields>
void describe(Fields& f, EquilibriumSpec& s) {
  f.optional("at", s.at, "one equilibrium at the centre of the bounds, or each sample's own");
  f.optionalMap("parameters", s.parameters, "values that replace the centre's");
  f.rule(s.at == EquilibriumAt::kBoxCenter || s.parameters.empty(),
         "must not give parameters together with 'at: sample'");
}

struct InitialSpec {
  std::vector<NamedExpression> coordinates;  ///< initial values, or the start of Newton's method; default 0
  std::vector<NamedExpression> speeds;       ///< initial time derivatives; not with an equilibrium; default 0
  std::optional<EquilibriumSpec> equilibrium;
};

template <class Fields>
void describe(Fields& f, InitialSpec& s) {
  f.optionalMap("coordinates", s.coordinates, "initial values, or where Newton's method starts; others 0");
  f.optionalMap("speeds", s.speeds, "initial time derivatives of coordinates; others 0");
  f.optional("equilibrium", s.equilibrium, "start at rest in the static equilibrium, without excitation");
  f.rule(!s.equilibrium || s.speeds.empty(), "must not give speeds together with an equilibrium");
}

}  // namespace twinmap
