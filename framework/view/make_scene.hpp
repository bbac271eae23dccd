#pragma once

#include <string>

#include "framework/experiment/experiment_spec.hpp"
#include "framework/view/scene.hpp"

namespace twinmap::view {

/// The mechanism of an experiment at a point of its parameters (collectSampled), at rest in its initial
/// state where it has no duration. `motion`: what the motion is called. It stands still, with a remark,
/// where the simulation fails. Throws ExperimentError for a model that is wrong, SimulationFailure for one
/// from elsewhere that fails. How many `frames`; 0: as many as a page has room for.
Scene makeScene(const ExperimentSpec& experiment, const Eigen::VectorXd& point, const std::string& motion,
                int frames = 0);

/// The same as it begins, or as the file says that it does where that cannot be solved for.
Scene makeStill(const ExperimentSpec& experiment, const Eigen::VectorXd& point);

/// Adds a motion at another point.
void addMotion(const ExperimentSpec& experiment, const Eigen::VectorXd& point, const std::string& motion,
               Scene& scene);

}  // namespace twinmap::view
