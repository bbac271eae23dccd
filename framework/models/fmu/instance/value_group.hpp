#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "framework/models/fmu/package/model_description.hpp"

namespace twinmap::fmi {

/// One number of a variable: its value, or an element of an array (FMI 3.0).
struct ValueSlot {
  const Variable* variable = nullptr;
  std::size_t element = 0;
};

/// Finds "spring.c" or "a[2]", "a[1,3]" (elements counted from 1). A variable that is itself named so comes
/// first. Throws ExperimentError for an unknown name, with the nearest one, an array without an element, an
/// element that is none, and a variable that is not a number (String, Binary, Clock).
ValueSlot findSlot(const ModelDescription& description, const std::string& name);

/// Numbers that are set or read together, prepared so that a call of the FMU is needed for each type only.
/// Arrays are set as a whole: elements that are not in the group keep their start values.
class ValueGroup {
 public:
  ValueGroup() = default;
  explicit ValueGroup(const std::vector<ValueSlot>& slots);

  std::size_t getCount() const { return count_; }

  /// What one call sets or reads.
  struct Batch {
    Type type;
    std::vector<std::uint32_t> references;
    std::vector<double> values;  ///< of all references, arrays with all elements
    struct Use {
      std::size_t position, slot;  ///< in `values`, and in what the caller gives
    };
    std::vector<Use> uses;
  };
  std::vector<Batch>& updBatches() { return batches_; }

 private:
  std::vector<Batch> batches_;
  std::size_t count_ = 0;
};

}  // namespace twinmap::fmi
