#pragma once

#include "framework/robots/xml/xml_file.hpp"

namespace twinmap::robots {

/// A robot from its URDF, with what is left out. Throws ExperimentError with file and line for what is not a
/// URDF, a xacro file, numbers that are none, names that are missing or given twice.
Robot readUrdf(const XmlFile& file);

}  // namespace twinmap::robots
