#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/data/features/feature_block.hpp"
#include "framework/experiment/model/model_spec.hpp"

namespace twinmap {

/// What a measurement shows of the start of its simulation. Of each unknown parameter (collectUnknown) that
/// is an initial coordinate or speed, where an output measures the coordinate: the parabola through its first
/// three samples, or its slope, at 0 s. NaN of the others; empty where nothing is shown. A search from
/// elsewhere in wide bounds may end far off: friction or a loop that is saturated turn the way there into
/// many (docs/benchmarks/real-machines/emps.md). features: of the infos, NaN where missing.
Eigen::VectorXd readShownStart(const ModelSpec& model, const std::vector<FeatureInfo>& infos,
                               const Eigen::VectorXd& features);

}  // namespace twinmap
