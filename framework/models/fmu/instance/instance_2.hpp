#pragma once

#include "framework/models/fmu/instance/functions_2.hpp"
#include "framework/models/fmu/instance/instance.hpp"

namespace twinmap::fmi {

/// An instance by FMI 2.0.
std::unique_ptr<Instance> makeInstance2(const Functions2& functions, const InstanceSource& source);

}  // namespace twinmap::fmi
