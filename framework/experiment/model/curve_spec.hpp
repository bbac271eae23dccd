#pragma once

#include <optional>
#include <string>
#include <vector>

#include "framework/experiment/expression/expression.hpp"
#include "framework/experiment/fields/fields.hpp"
#include "framework/experiment/model/bounds_spec.hpp"

namespace twinmap {

inline constexpr NumberRule kKnotCount{2.0, 50.0, true, "must be a whole number from 2 to 50"};

/// A static curve of a machine that expressions use as a function, `motor(u)`. Smooth between knots at equal
/// distances over `range`, whose values are expressions of parameters and constants; a straight line beyond
/// (curve.hpp).
struct CurveSpec {
  Name name;
  Name over;     ///< what it is a curve of, for its unit and the pictures: a coordinate, state or signal
  Bounds range;  ///< of that
  std::string unit;
  std::vector<Expression> values;  ///< at the knots
  bool monotone = false;           ///< never leaves the range of two neighbouring knots between them
  std::optional<int> knots;        ///< instead of values: so many parameters, <name>_1 and on
  std::optional<Bounds> bounds;    ///< of each of them
};

template <class Fields>
void describe(Fields& f, CurveSpec& s) {
  f.required("over", s.over, "the coordinate, speed, state or signal that it is a curve of");
  f.required("range", s.range, "[first, last] knot, which lie at equal distances");
  f.optional("unit", s.unit, "coherent SI unit of its values");
  f.optional("values", s.values, "at the knots: expressions of parameters and constants", kNotEmpty,
             kOwnUnit);
  f.optional("knots", s.knots, "instead of values: a parameter for each, NAME_1 and on", kKnotCount);
  f.optional("bounds", s.bounds, "of each of these parameters");
  f.optional("monotone", s.monotone, "between two knots it stays between their values");
  f.rule(s.values.empty() == s.knots.has_value(), "must give either 'values' or 'knots'");
  f.rule(s.knots.has_value() == s.bounds.has_value(), "must give 'bounds' with 'knots', and only there");
  f.rule(s.values.empty() || (s.values.size() >= 2 && s.values.size() <= 50),
         "must give from 2 to 50 of values");
}

}  // namespace twinmap
