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

/// Adds what was measured and the residuals to the outputs of a scene, whose last motion is the updated
/// model's; and the measured motion. `experiment`, `point`: of the updated model.
///
/// The measured motion has the poses nearest to the updated model's that explain the sensors of coordinates
/// and positions. Coordinates that no sensor determines follow that model. There is none without such
/// sensors, and none of loops.
void addMeasurement(const ExperimentSpec& experiment, const Eigen::VectorXd& point,
                    const Measurement& measurement, Scene& scene);

}  // namespace twinmap::view
