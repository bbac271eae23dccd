#pragma once

#include <vector>

#include "framework/base/hdf5/hdf5_file.hpp"
#include "framework/experiment/model/model_spec.hpp"

namespace twinmap {

/// A group such as /parameters, which samples.h5 and maps.h5 have: name, unit, lower, upper of each
/// parameter.
void writeParametersGroup(Hdf5Writer& file, const std::string& group,
                          const std::vector<ParameterSpec>& parameters);

/// Reads the group back (names, units and bounds only).
std::vector<ParameterSpec> readParametersGroup(const Hdf5Reader& file, const std::string& group);

}  // namespace twinmap
