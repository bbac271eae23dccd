#pragma once

#include <limits>
#include <string>
#include <vector>

namespace twinmap {

/// What a number must satisfy; checked when read, and written into the JSON schema.
struct NumberRule {
  double minimum = -std::numeric_limits<double>::infinity();
  double maximum = std::numeric_limits<double>::infinity();
  bool minimum_allowed = true;  ///< false: strictly above
  const char* text = "must be a number";
};

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr NumberRule kAnyNumber{};
inline constexpr NumberRule kPositive{0.0, kInfinity, false, "must be a number above 0"};
inline constexpr NumberRule kNonNegative{0.0, kInfinity, true, "must be a number, 0 or above"};
inline constexpr NumberRule kFraction{0.0, 1.0, true, "must be a fraction from 0 to 1"};
inline constexpr NumberRule kSampleInterval{1e-9, kInfinity, true, "must be a number, 1e-9 or above"};
inline constexpr NumberRule kSampleCount{1.0, 1e6, true, "must be a whole number from 1 to 1000000"};
inline constexpr NumberRule kThousand{1.0, 1e3, true, "must be a whole number from 1 to 1000"};
inline constexpr NumberRule kHundredThousand{1.0, 1e5, true, "must be a whole number from 1 to 100000"};
inline constexpr NumberRule kCountOrNone{0.0, 1e5, true, "must be a whole number from 0 to 100000"};
inline constexpr NumberRule kCount{1.0, 1e7, true, "must be a whole number from 1 to 10000000"};

/// Of a list whose absence means a default other than none.
struct ListRule {
  std::size_t minimum = 0;
  const char* text = "";
};

inline constexpr ListRule kNotEmpty{1, "must not be empty; leave the key out for the default"};

template <class Enum>
struct EnumName {
  const char* text;
  Enum value;
};

/// The names of an enum's values in the experiment file: specialised beside each description, with a member
/// `static constexpr EnumName<Enum> values[]`.
template <class Enum>
struct EnumNames;

template <class Enum>
const char* getEnumText(Enum value) {
  for (const EnumName<Enum>& name : EnumNames<Enum>::values) {
    if (name.value == value) {
      return name.text;
    }
  }
  return "";
}

/// How structs are described. Beside each struct of the experiment there is
///
///   template <class Fields> void describe(Fields& f, SpringSpec& s) {
///     f.required("coordinate", s.coordinate, "the coordinate it acts on");
///     f.optional("rest", s.rest, "where the force vanishes; m or rad");
///     f.rule(condition, "must ...");
///   }
///
/// and visitors with these members that read YAML into it (FieldReader), write it out (FieldWriter) and
/// derive the JSON schema (json_schema.cpp), so that a key is named in one place.
///   required, optional         a value; an optional one keeps its default when absent
///   requiredMap, optionalMap   a vector of structs with a Name `name`, written as a map from name to struct
///   oneOf                      keys of which exactly one is given (one_of.hpp)
///   rule                       a condition over several fields
///   value                      instead of keys: the struct is written as this value alone
///   scalarIsKey, scalarIsValueOf   called first: a scalar is short for the map {scalar: {}}, {key: scalar}
///   location                   where the struct stands in its file

}  // namespace twinmap
