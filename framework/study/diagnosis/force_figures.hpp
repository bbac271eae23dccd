#pragma once

#include <vector>

#include "framework/diagnosis/picture/unknown_force.hpp"
#include "framework/study/diagnosis/drawn_diagnosis.hpp"

namespace twinmap {

/// The force on each coordinate that is missing from the model, over speed, position and time; its data go to
/// the page.
Section makeForceSection(const DrawnDiagnosis& drawn, const std::vector<UnknownForce>& forces, Page& page);

}  // namespace twinmap
