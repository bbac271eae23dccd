#pragma once

#include <string>

#include "framework/experiment/expression/expression.hpp"
#include "framework/experiment/fields/fields.hpp"

namespace twinmap {

/// A state of first order beside those of the bodies: a current, a temperature, a filter.
struct StateSpec {
  Name name;
  Expression derivative;  ///< with respect to time, in `unit`/s
  Expression initial;     ///< of parameters and constants; where an equilibrium's search starts
  std::string unit;
};

template <class Fields>
void describe(Fields& f, StateSpec& s) {
  f.required("derivative", s.derivative,
             "its rate; may use states, coordinates, speeds, excitation signals and t",
             Unit{"", nullptr, true, true});
  f.optional("initial", s.initial, "its value at the start; where the search of an equilibrium begins",
             kOwnUnit);
  f.optional("unit", s.unit, "unit of the state");
}

}  // namespace twinmap
