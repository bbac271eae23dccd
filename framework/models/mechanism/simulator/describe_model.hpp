#pragma once

#include <string>
#include <vector>

#include "framework/models/mechanism/lanes/lane_model.hpp"
#include "framework/models/mechanism/model_context.hpp"

namespace twinmap {

/// Begins the line that says what grows about an unstable equilibrium, and why.
inline constexpr const char* kUnstableLine = "unstable";

/// What Simulator::describeModel() says of a system: bodies, coordinates, loops, degrees of freedom, states,
/// and at the centre of the bounds the static equilibrium without excitation with the modes of lowest
/// frequency. `lanes`: null where they cannot simulate it; then neither loops nor equilibrium are known.
/// `box_center`: the equilibrium that all samples start from, or empty.
std::vector<std::string> describeModel(ModelContext& context, const LaneModel* lanes,
                                       const Eigen::VectorXd& box_center);

}  // namespace twinmap
