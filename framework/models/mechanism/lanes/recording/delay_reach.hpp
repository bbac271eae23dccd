#pragma once

#include <Eigen/Core>
#include <string>

#include "framework/experiment/model/model_spec.hpp"

namespace twinmap {

/// The least and the largest value of a time (s) within the parameters' bounds, and 0: at the centre, at both
/// ends and where one parameter alone is at an end of its bounds. owner: whose it is, for errors.
Bounds calcReach(const ModelSpec& model, const Expression& expression, const std::string& owner);

/// Throws ExperimentError where the delay of a sensor may be so negative that the last of `times`
/// (increasing) shows what is behind the end of the simulation.
void requireWithinSimulation(const ModelSpec& model, const Eigen::VectorXd& times);

}  // namespace twinmap
