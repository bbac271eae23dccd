#pragma once

#include <Eigen/Core>

#include "framework/base/random/random.hpp"
#include "framework/experiment/experiment_spec.hpp"

namespace twinmap {

/// Points of the sampled box (collectSampled; m x n) at those of the unit cube (m x n): scaled to the bounds,
/// or, where there are priors, their points there (Prior::calcPoint). Where bounds cut off a part of
/// correlated priors, some points are replaced by uniform ones, so that uniform points give draws of the
/// prior. `seed` and `purpose`: of these.
Eigen::MatrixXd placeInPrior(const ModelSpec& model, const Eigen::MatrixXd& unit, std::uint64_t seed,
                             RandomPurpose purpose);

/// The training points of an experiment (m x n); none without a map.
Eigen::MatrixXd sampleTrainPoints(const ExperimentSpec& experiment);

/// The test points, likewise.
Eigen::MatrixXd sampleTestPoints(const ExperimentSpec& experiment);

}  // namespace twinmap
