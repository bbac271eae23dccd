#pragma once

#include <Eigen/Core>

#include "framework/experiment/experiment_spec.hpp"

namespace twinmap {

/// The training points of an experiment in its sampled box (collectSampled): parameters x n; none without a
/// map.
Eigen::MatrixXd sampleTrainPoints(const ExperimentSpec& experiment);

/// The test points, likewise: scaled to the bounds, or, where there are priors, their points at those of the
/// unit cube (Prior::calcPoint). Where bounds cut off a part of correlated priors, some points are replaced
/// by uniform ones, so that all are draws of the prior.
Eigen::MatrixXd sampleTestPoints(const ExperimentSpec& experiment);

}  // namespace twinmap
