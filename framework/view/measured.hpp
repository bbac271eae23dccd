#pragma once

#include "framework/experiment/experiment_spec.hpp"
#include "framework/simulation/response_layout.hpp"
#include "framework/view/scene.hpp"

namespace twinmap::view {

/// A measurement and the model's answer to it: rows of the layout, NaN where nothing was measured.
struct Measurement {
  const ResponseLayout& layout;
  const Eigen::VectorXd &measured, &updated, &noise_stddev;
};

/// Adds to the outputs of a scene, whose last motion is the updated model's, what was measured of them and
/// the residuals; and to the motions the measured one. `experiment`, `point`: of the updated model.
///
/// Of the poses that explain the sensors of coordinates and positions, the measured motion has those nearest
/// to the updated model's: coordinates that no sensor determines follow it. There is none without such
/// sensors and none of mechanisms with loops.
void addMeasurement(const ExperimentSpec& experiment, const Eigen::VectorXd& point,
                    const Measurement& measurement, Scene& scene);

}  // namespace twinmap::view
