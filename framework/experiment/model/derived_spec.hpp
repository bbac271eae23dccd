#pragma once

#include <string>

#include "framework/experiment/expression/expression.hpp"
#include "framework/experiment/fields/fields.hpp"

namespace twinmap {

/// A quantity that follows from the updating parameters and is reported as they are. No simulation depends on
/// it. May use updating parameters, constants that follow from these alone, and quantities derived before it.
struct DerivedSpec {
  Name name;
  Expression value;
  std::string unit;  ///< coherent SI unit, "" if not stated
  std::string description;
};

template <class Fields>
void describe(Fields& f, DerivedSpec& s) {
  f.scalarIsValueOf("value");
  f.required("value", s.value, "expression of parameters, constants and quantities derived before");
  f.optional("unit", s.unit, "coherent SI unit, such as kg m; checked against the expression");
  f.optional("description", s.description, "human-readable");
}

}  // namespace twinmap
