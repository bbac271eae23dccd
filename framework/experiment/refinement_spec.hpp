#pragma once

#include "framework/experiment/fields/fields.hpp"

namespace twinmap {

/// Whether what a map infers is refined on the simulator; kAutomatic: where that is cheap.
enum class RefineMode { kNever, kAutomatic, kAlways };

template <>
struct EnumNames<RefineMode> {
  static constexpr EnumName<RefineMode> values[] = {
      {"never", RefineMode::kNever},
      {"automatic", RefineMode::kAutomatic},
      {"always", RefineMode::kAlways},
  };
};

}  // namespace twinmap
