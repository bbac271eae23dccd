#pragma once

#include "framework/spec/fields/fields.hpp"
#include "framework/spec/sweep/sweep_spec.hpp"

namespace twinmap {

template <>
struct EnumNames<SweepCombine> {
  static constexpr EnumName<SweepCombine> values[] = {{"grid", SweepCombine::kGrid},
                                                      {"zip", SweepCombine::kZip}};
};

template <class Fields>
void describe(Fields& f, SweepSpec& s) {
  f.required("over", s.over, "key paths, each with a list of values or a range such as 1..10");
  f.optional("combine", s.combine,
             "grid: every combination of values; zip: the first values, the second ...");
}

}  // namespace twinmap
