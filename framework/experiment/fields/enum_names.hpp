#pragma once

namespace twinmap {

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

}  // namespace twinmap
