#pragma once

#include <Eigen/Core>

#include "framework/experiment/experiment_spec.hpp"

namespace twinmap {

/// The training points of an experiment in its sampled box (collectSampled): parameters x n; none without a
/// map.
Eigen::MatrixXd sampleTrainPoints(const ExperimentSpec& experiment);

/// The test points, likewise.
Eigen::MatrixXd sampleTestPoints(const ExperimentSpec& experiment);

}  // namespace twinmap
