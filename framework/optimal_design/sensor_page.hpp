#pragma once

#include <string>

#include "framework/optimal_design/sensor_design.hpp"

namespace twinmap::experiment_design {

/// The page of a design of sensors: what each further output and sample time buys, and when is measured.
std::string makeSensorPage(const std::string& name, const SensorDesign& design);

}  // namespace twinmap::experiment_design
