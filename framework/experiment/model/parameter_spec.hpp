#pragma once

#include <optional>
#include <string>

#include "framework/experiment/expression/expression.hpp"
#include "framework/experiment/fields/fields.hpp"
#include "framework/experiment/model/bounds_spec.hpp"
#include "framework/experiment/model/prior_spec.hpp"

namespace twinmap {

/// What the relative error of a parameter is relative to: its true value, or the width of its bounds;
/// kAutomatic: the value, or the range where the bounds contain 0 (isRelativeToRange).
enum class RelativeTo { kAutomatic, kValue, kRange };

template <>
struct EnumNames<RelativeTo> {
  static constexpr EnumName<RelativeTo> values[] = {
      {"automatic", RelativeTo::kAutomatic}, {"value", RelativeTo::kValue}, {"range", RelativeTo::kRange}};
};

/// A parameter of the model, sampled within its bounds for training.
struct ParameterSpec {
  Name name;
  Bounds bounds;     ///< in `unit`
  std::string unit;  ///< coherent SI unit, "" if not stated
  std::string description;
  RelativeTo relative_to = RelativeTo::kAutomatic;  ///< of an updating parameter
  std::optional<Name> variable;                     ///< of a model from elsewhere; default: the name
  std::optional<PriorSpec> prior{};                 ///< default: uniform within the bounds
  /// Whether derivatives by it are asked for; where not, they may be given as 0. Not in the file.
  bool has_derivatives = true;
};

/// Whether the bounds contain 0, where an error relative to the value is undefined.
inline bool containsZero(const Bounds& bounds) {
  return bounds.lower <= 0.0 && bounds.upper >= 0.0;
}

inline bool isRelativeToRange(const ParameterSpec& parameter) {
  return parameter.relative_to == RelativeTo::kRange ||
         (parameter.relative_to == RelativeTo::kAutomatic && containsZero(parameter.bounds));
}

template <class Fields>
void describe(Fields& f, ParameterSpec& s) {
  f.optional("bounds", s.bounds,
             "[lower, upper], within which samples lie; default: the prior's range of .9999");
  f.optional("prior", s.prior,
             "what is known of it before a measurement; default: uniform within the bounds");
  f.optional("unit", s.unit, "coherent SI unit, such as N s/m; shown in tables and checked where it is used");
  f.optional("description", s.description, "human-readable");
  f.optional("relative_to", s.relative_to,
             "what relative errors are relative to: the value, or the range (upper - lower); automatic: the "
             "value, or the range where the bounds contain 0");
  f.optional("variable", s.variable, "its name in the FMU or program; default: its own");
  f.rule(s.bounds.isGiven() || (s.prior && s.prior->hasRange()),
         "must give 'bounds', or a normal, lognormal or student_t prior");
  f.rule(!s.prior || !s.prior->isOfLogarithm() || !s.bounds.isGiven() || s.bounds.lower > 0.0,
         "must have bounds above 0 where the prior is of the logarithm");
}

/// A named value of the model; may use parameters of any kind and the constants declared before it.
struct ConstantSpec {
  Name name;
  Expression value;
  std::string unit;
  std::string description;
  std::optional<Name> variable;  ///< of a model from elsewhere, which is set to it
};

template <class Fields>
void describe(Fields& f, ConstantSpec& s) {
  f.scalarIsValueOf("value");
  f.required("value", s.value, "number, or expression of parameters and constants declared before");
  f.optional("unit", s.unit, "coherent SI unit; checked where the constant is used");
  f.optional("description", s.description, "human-readable");
  f.optional("variable", s.variable, "a parameter or start value of the FMU or program that is set to it");
}

}  // namespace twinmap
