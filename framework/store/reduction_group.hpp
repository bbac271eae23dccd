#pragma once

#include <string>

#include "framework/base/hdf5/hdf5_file.hpp"
#include "framework/data/reduction/response_reduction.hpp"

namespace twinmap {

/// Writes a reduction below a group, but for the rows of its windows, which follow from the experiment
/// (partResponse).
void writeReduction(Hdf5Writer& file, const std::string& group, const ResponseReduction& reduction);

/// Reads it back, without rows (placeRows). Throws std::runtime_error where its parts do not fit each other.
ResponseReduction readReduction(const Hdf5Reader& file, const std::string& group);

/// Gives the windows their rows. Throws std::runtime_error where the experiment has others.
void placeRows(const ExperimentSpec& experiment, const ResponseLayout& layout, ResponseReduction& reduction);

}  // namespace twinmap
