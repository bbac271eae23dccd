#pragma once

#include "framework/fmi/functions_3.hpp"
#include "framework/fmi/instance.hpp"

namespace twinmap::fmi {

/// An instance by FMI 3.0. Event mode is not used in Co-Simulation: the FMU handles its events itself.
std::unique_ptr<Instance> makeInstance3(const Functions3& functions, const InstanceSource& source);

}  // namespace twinmap::fmi
