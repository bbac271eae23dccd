#pragma once

#include <Eigen/Core>

#include "framework/estimation/gp/gp_map.hpp"
#include "framework/estimation/run_tasks.hpp"

namespace twinmap {

/// What the map would have predicted for each training sample, had the sample and its siblings (the other
/// draws of the noise of the same simulation) been left out; in the parameters' units, p x n. Transform and
/// hyperparameters are kept. `inputs` (k x n, transformed) and `targets` (p x n, standardised) are those the
/// processes were trained on. Throws gp::Stopped between two processes. Cost: n^3 / 3 flops per exact
/// process, 3 n m^2 per sparse one.
Estimates predictLeftOut(const GpMap& map, const Eigen::MatrixXd& inputs, const Eigen::MatrixXd& targets,
                         int replicates, const TrainingControl& control);

}  // namespace twinmap
