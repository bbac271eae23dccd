#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/data/features/feature_block.hpp"
#include "framework/experiment/model/model_spec.hpp"

namespace twinmap {

/// What a measurement shows of the start of its simulation, of each unknown parameter (collectUnknown). An
/// initial coordinate that a known sensor measures is where the parabola through its
/// first three samples begins, at 0 s. Its speed is the slope there, or that of an output of speed. NaN of
/// others; empty where nothing is shown. A search from elsewhere in wide bounds may end far off, where
/// friction or a saturated loop stand between (docs/benchmarks/real-machines/emps.md). features: of the
/// infos, NaN where missing.
Eigen::VectorXd readShownStart(const ModelSpec& model, const std::vector<FeatureInfo>& infos,
                               const Eigen::VectorXd& features);

}  // namespace twinmap
