#pragma once

#include <string>
#include <vector>

#include "framework/experiment/model/model_spec.hpp"

namespace twinmap {

/// Angles that are more than a turn if they are in rad, as in sin(30), a phrase each.
std::vector<std::string> listDegrees(const ModelSpec& model);

/// What speaks against a model before anything is simulated, a phrase each: angles in degrees, forces that
/// jump, so that steps become small, and an equilibrium that it leaves by itself. Empty of a model from
/// elsewhere. Cost: that of making a simulator, some milliseconds.
std::vector<std::string> listModelRemarks(const ModelSpec& model);

}  // namespace twinmap
