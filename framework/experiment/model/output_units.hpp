#pragma once

#include <string>

#include "framework/experiment/model/joint_type.hpp"
#include "framework/experiment/model/output_spec.hpp"
#include "framework/experiment/model/system_spec.hpp"

namespace twinmap {

/// m, rad, m/s, rad/s or m/s2, of what is not a force, a variable or an expression. `kind`: that of its
/// coordinate, if it measures one.
const char* getOutputUnit(const OutputSpec& output, CoordinateKind kind);

/// The same, or what is stated for a variable or an expression; finds the coordinate among the system's
/// joints. "" if there is no such coordinate.
std::string findOutputUnit(const OutputSpec& output, const SystemSpec& system);

}  // namespace twinmap
