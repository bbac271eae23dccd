#pragma once

#include <vector>

#include "framework/data/features/labelled_features.hpp"
#include "framework/estimation/training_control.hpp"
#include "framework/experiment/experiment_spec.hpp"
#include "kernels/gp/training.hpp"

namespace twinmap {

/// What an experiment says of its maps, in the kernels' terms.
gp::TrainingOptions makeTrainingOptions(const GpMapSpec& spec, const TrainingControl& control);

/// The structure of processes with `inputs` inputs, the last `known` of them known inputs, which have a
/// length scale each. `infos`: of the features before the transform; length scales per output are for
/// transforms that keep the features.
gp::ModelStructure makeStructure(const GpMapSpec& spec, const std::vector<FeatureInfo>& infos, int inputs,
                                 int known);

}  // namespace twinmap
