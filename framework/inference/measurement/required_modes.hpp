#pragma once

#include <string>

#include "framework/inference/measurement_reader.hpp"

namespace twinmap {

/// Throws MeasurementError where a table of modes lacks all that a feature asks for, as where a column has
/// another name.
void requireModes(const AvailableFeatures& found, const MeasurementReader& reader, const std::string& source);

}  // namespace twinmap
