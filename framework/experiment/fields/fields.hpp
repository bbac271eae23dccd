#pragma once

#include <cstddef>
#include <type_traits>

#include "framework/experiment/fields/enum_names.hpp"
#include "framework/experiment/fields/number_rule.hpp"

namespace twinmap {

/// Of a list whose absence means a default other than none.
struct ListRule {
  std::size_t minimum = 0;
  const char* text = "";
};

/// The coherent SI unit in which an expression must come out. Checked where all names are known
/// (check/check_model.cpp), and written into the JSON schema.
struct Unit {
  const char* text;  ///< "" is checked to be finite only
  const char* rotation =
      nullptr;          ///< on a coordinate that is an angle, and in the first three of six directions
  bool varies = false;  ///< may use coordinates, speeds, signals and the time
  bool own = false;     ///< the unit that is stated beside: of a signal, of an output
  double power = 1.0;   ///< of its last factor, m in N/m; NaN where it is not known, which checks nothing
};

inline constexpr Unit kNoUnit{""};
inline constexpr Unit kOwnUnit{"", nullptr, false, true};

/// What a name must refer to; checked with the units.
enum class Reference {
  kBody,              ///< or ground
  kEarlierBody,       ///< declared before, or ground
  kCoordinate,        ///< of a joint
  kForcedCoordinate,  ///< one on which forces may act
};

/// Rules that need more than the value itself, so that the reader leaves them to the checks.
template <class Rule>
inline constexpr bool kIsCheckedLater = std::is_same_v<Rule, Unit> || std::is_same_v<Rule, Reference>;

inline constexpr ListRule kNotEmpty{1, "must not be empty; leave the key out for the default"};

/// How structs are described. Beside each struct of the experiment there is
///
///   template <class Fields> void describe(Fields& f, BodySpec& s) {
///     f.required("mass", s.mass, "of the body", Unit{"kg"});
///     f.optional("center_of_mass", s.center_of_mass, "in the body's frame", Unit{"m"});
///     f.rule(condition, "must ...");
///   }
///
/// and visitors with these members that read YAML into it (FieldReader), write it out (FieldWriter), derive
/// the JSON schema (json_schema.cpp) and check units and references (check/check_model.cpp), so that a key is
/// named in one place.
///   required, optional         a value; an optional one keeps its default when absent
///   requiredMap, optionalMap   a vector of structs with a Name `name`, written as a map from name to struct
///   oneOf                      keys of which exactly one is given (one_of.hpp)
///   rule                       a condition over several fields
///   value                      instead of keys: the struct is written as this value alone
///   scalarIsKey, scalarIsValueOf   called first: a scalar is short for the map {scalar: {}}, {key: scalar}
///   location                   where the struct stands in its file

}  // namespace twinmap
