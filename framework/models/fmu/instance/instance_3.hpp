#pragma once

#include "framework/models/fmu/instance/functions_3.hpp"
#include "framework/models/fmu/instance/instance.hpp"

namespace twinmap::fmi {

/// An instance by FMI 3.0. Co-Simulation uses event mode where the FMU has it, and no clocks that follow the
/// time.
std::unique_ptr<Instance> makeInstance3(const Functions3& functions, const InstanceSource& source);

}  // namespace twinmap::fmi
