#pragma once

#include "framework/experiment/experiment_spec.hpp"
#include "framework/view/scene.hpp"

namespace twinmap::view {

/// Adds the oscillating modes, by increasing frequency, about the equilibrium that is found from the initial
/// state. There are none without an equilibrium, of loops, and of a model that lanes do not simulate.
void addModes(const ModelSpec& model, const Eigen::VectorXd& point, Scene& scene);

}  // namespace twinmap::view
