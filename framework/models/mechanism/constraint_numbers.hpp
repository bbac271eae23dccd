#pragma once

#include <vector>

#include "framework/models/mechanism/system_numbers.hpp"

namespace twinmap {

/// The numbers of a constraint for one parameter set; of its kind, the others are 0.
struct ConstraintNumbers {
  BodyPoint from{}, to{};                 ///< of a point in a plane: a point of the plane, and the point;
                                          ///< of rolling likewise, and the center
  FrameNumbers from_frame{}, to_frame{};  ///< of a weld or pin
  Eigen::Vector3d normal{};               ///< of the plane, of any length but 0
  double length = 0.0;                    ///< of a rod, or the radius of what rolls; positive
  int coordinate = -1, driver = -1;
  double ratio = 0.0, offset = 0.0;
};

/// Those of all constraints, in the file's order. Throws SimulationFailure for numbers that are not finite,
/// for a length or radius that is not positive, and for a normal of no length.
std::vector<ConstraintNumbers> calcConstraintNumbers(const SystemSpec& spec, const SystemNames& names,
                                                     ModelNumbers& numbers);

}  // namespace twinmap
