#pragma once

#include "framework/study/pipeline/preparation/prepare_data.hpp"
#include "framework/study/pipeline/training/trained_map.hpp"

namespace twinmap {

/// OnlineModel::shared_error. The map infers the responses without noise of at most 200 test samples, whose
/// 95 % quantile is known to 10 %. Features that noise biases (a peak) count as wrong by that: the error is
/// then too large, not too small.
Eigen::VectorXd calcSharedError(const Study& study, const PreparedData& data, const TrainedMap& map);

}  // namespace twinmap
