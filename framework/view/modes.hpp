#pragma once

#include "framework/experiment/experiment_spec.hpp"
#include "framework/view/scene.hpp"

namespace twinmap::view {

/// Adds the oscillating modes of the mechanism linearised about the equilibrium that is found from its
/// initial state, by increasing frequency; none where there is no equilibrium, and none of loops or of a
/// model that lanes do not simulate.
void addModes(const ModelSpec& model, const Eigen::VectorXd& point, Scene& scene);

}  // namespace twinmap::view
