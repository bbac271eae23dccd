#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "framework/models/fmu/instance/failure.hpp"
#include "framework/models/fmu/instance/value_group.hpp"

namespace twinmap::fmi {

/// The value as the native type, rounded to the nearest; of bool, true from one half on. Throws FmuFailure
/// for a number that the type cannot hold. The largest integer of 64 bits is between two doubles: the one
/// above stands for it.
template <class Native>
Native toNative(double value) {
  if constexpr (std::is_floating_point_v<Native>) {
    return static_cast<Native>(value);
  } else if constexpr (std::is_same_v<Native, bool>) {
    return value >= 0.5;
  } else {
    const double rounded = std::round(value);
    // 2^digits is exact as a double, the largest integer itself may not be
    const double above = std::ldexp(1.0, std::numeric_limits<Native>::digits);
    const double lowest = static_cast<double>(std::numeric_limits<Native>::lowest());
    if (rounded == above && std::numeric_limits<Native>::digits > std::numeric_limits<double>::digits) {
      return std::numeric_limits<Native>::max();
    }
    if (!(rounded >= lowest && rounded < above)) {
      throw FmuFailure("a value of " + std::to_string(value) + " does not fit the variable's integer type");
    }
    return static_cast<Native>(rounded);
  }
}

/// Calls `set(references, count, values, value count)` of the FMU with the batch's values as its native type.
template <class Native, class Set>
void setBatch(const ValueGroup::Batch& batch, const Set& set) {
  if constexpr (std::is_same_v<Native, double>) {
    set(batch.references.data(), batch.references.size(), batch.values.data(), batch.values.size());
  } else {
    const std::size_t count = batch.values.size();
    const auto values = std::make_unique<Native[]>(count);  // std::vector<bool> has no data()
    std::transform(batch.values.begin(), batch.values.end(), values.get(), toNative<Native>);
    set(batch.references.data(), batch.references.size(), values.get(), count);
  }
}

template <class Native, class Get>
void getBatch(ValueGroup::Batch& batch, const Get& get) {
  if constexpr (std::is_same_v<Native, double>) {
    get(batch.references.data(), batch.references.size(), batch.values.data(), batch.values.size());
  } else {
    const std::size_t count = batch.values.size();
    const auto values = std::make_unique<Native[]>(count);
    get(batch.references.data(), batch.references.size(), values.get(), count);
    std::transform(values.get(), values.get() + count, batch.values.begin(),
                   [](Native value) { return static_cast<double>(value); });
  }
}

/// From and to the order of the group's slots.
inline void scatter(const double* values, ValueGroup::Batch& batch) {
  for (const ValueGroup::Batch::Use& use : batch.uses) {
    batch.values[use.position] = values[use.slot];
  }
}

inline void gather(const ValueGroup::Batch& batch, double* values) {
  for (const ValueGroup::Batch::Use& use : batch.uses) {
    values[use.slot] = batch.values[use.position];
  }
}

}  // namespace twinmap::fmi
