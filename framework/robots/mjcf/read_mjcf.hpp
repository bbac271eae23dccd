#pragma once

#include "framework/robots/xml/xml_file.hpp"

namespace twinmap::robots {

/// A robot as MuJoCo compiles its MJCF: by Python's package mujoco, of the python3 that is found first.
/// Throws ExperimentError where Python, the package or a file is missing, and with MuJoCo's words for a file
/// that it does not compile.
Robot readMjcf(const XmlFile& file);

}  // namespace twinmap::robots
