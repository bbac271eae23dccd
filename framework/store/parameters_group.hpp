#pragma once

#include <vector>

#include "framework/spec/model_spec.hpp"
#include "framework/store/hdf5_file.hpp"

namespace twinmap {

/// The group /parameters that samples.h5 and maps.h5 share: name, unit, lower, upper of each parameter.
void writeParametersGroup(Hdf5Writer& file, const std::vector<ParameterSpec>& parameters);

/// Reads the group back (names, units and bounds only).
std::vector<ParameterSpec> readParametersGroup(const Hdf5Reader& file);

}  // namespace twinmap
