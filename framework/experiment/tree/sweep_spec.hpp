#pragma once

#include <string>
#include <vector>

#include "framework/experiment/fields/fields.hpp"
#include "framework/experiment/yaml/yaml_node.hpp"

namespace twinmap {

/// A key of the experiment and the values it takes.
struct SweptKey {
  std::string key;               ///< key path: "design.train.samples"
  std::vector<YamlNode> values;  ///< any YAML; ranges a..b are expanded
  SourceLocation where;
};

struct SweptKeys {
  std::vector<SweptKey> keys;  ///< none is part of another; no value occurs twice
};

/// Every value with every other, or the first with the first, the second with the second ...
enum class SweepCombine { kGrid, kZip };

template <>
struct EnumNames<SweepCombine> {
  static constexpr EnumName<SweepCombine> values[] = {{"grid", SweepCombine::kGrid},
                                                      {"zip", SweepCombine::kZip}};
};

/// The experiment is repeated with other values of some keys.
struct SweepSpec {
  SweptKeys over;
  SweepCombine combine = SweepCombine::kGrid;
};

template <class Fields>
void describe(Fields& f, SweepSpec& s) {
  f.required("over", s.over, "key paths, each with a list of values or a range such as 1..10");
  f.optional("combine", s.combine,
             "grid: every combination of values; zip: the first values, the second ...");
}

}  // namespace twinmap
