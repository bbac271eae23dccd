#pragma once

#include <Eigen/Core>

#include "framework/spec/experiment_spec.hpp"
#include "framework/store/trajectory_store.hpp"

namespace twinmap {

/// The points whose neighbourhoods (NeighbourhoodSimulator) a run of the experiment needs: the test points
/// for the information limit, where outputs have noise, and the first training points for a selection by
/// Fisher information. Parameters x n, n = 0 if it needs none. Neighbourhoods of samples that fail are not
/// needed after all.
Eigen::MatrixXd listNeededNeighbourhoods(const ExperimentSpec& experiment);

/// Those of the points whose sample has not failed, as far as the store of the samples knows.
Eigen::MatrixXd dropFailed(const Eigen::MatrixXd& points, const TrajectoryStore& samples);

/// Whether a step of the transform selects features by Fisher information, and the number of training samples
/// whose sensitivities it looks at.
bool selectsByFisherInformation(const ExperimentSpec& experiment);
inline constexpr int kSensitivitySamples = 16;

}  // namespace twinmap
