#pragma once

#include "framework/models/mechanism/lanes/recording/sampled_model.hpp"

namespace twinmap {

/// Throws ExperimentError for a controller whose delays take more than 1000 sample times.
RecordedSampling recordSampling(const SampledModel& sampled);

}  // namespace twinmap
