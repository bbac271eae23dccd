#pragma once

#include <optional>
#include <string>
#include <vector>

#include "framework/experiment/expression/expression.hpp"
#include "framework/experiment/fields/fields.hpp"

namespace twinmap {

/// A number within a candidate's force that is not known either, such as a distance over which it decays.
struct CandidateScaleSpec {
  Name name;                   ///< as the force uses it
  std::vector<double> values;  ///< tried one after the other; fitted from the best
  std::string unit;
};

template <class Fields>
void describe(Fields& f, CandidateScaleSpec& s) {
  f.required("name", s.name, "what the force calls it");
  f.required("values", s.values, "above 0; tried one after the other, and fitted from the best");
  f.optional("unit", s.unit, "coherent SI unit");
  f.rule(!s.values.empty() && s.values.size() <= 20, "must give 1 to 20 values");
  bool positive = true;
  for (const double value : s.values) {
    positive = positive && value > 0.0;
  }
  f.rule(positive, "must give values above 0");
}

/// A term that the model may lack (docs/how-to/find-what-a-model-lacks.md): a coefficient, named as the
/// candidate, times `force`. No simulation of the experiment depends on it.
struct CandidateSpec {
  Name name;
  Name coordinate;
  Expression force;  ///< that a coefficient of 1 makes, on the coordinate
  std::string unit;  ///< of the coefficient
  std::optional<CandidateScaleSpec> scale;
  std::string description;
};

template <class Fields>
void describe(Fields& f, CandidateSpec& s) {
  f.required("coordinate", s.coordinate, "the coordinate that the force acts on");
  f.required("force", s.force, "what the coefficient multiplies, as -tanh(x_dot/0.01)");
  f.optional("unit", s.unit, "coherent SI unit of the coefficient");
  f.optional("scale", s.scale, "a number in the force that is fitted as well");
  f.optional("description", s.description, "human-readable");
}

}  // namespace twinmap
