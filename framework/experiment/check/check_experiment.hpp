#pragma once

#include "framework/experiment/experiment_spec.hpp"

namespace twinmap {

/// Everything that a single value cannot show: names refer to something, names are unique, expressions use
/// known names and come out in the right unit, joints have their coordinates, feature times lie within the
/// simulation, every output has its noise. Throws ExperimentError for the first thing wrong.
void checkExperiment(const ExperimentSpec& experiment);

/// All but its model: of one whose model has been checked.
void checkBesideModel(const ExperimentSpec& experiment);

/// Parts of it, in this order.
void checkModel(const ModelSpec& model);
void checkTransform(const ExperimentSpec& experiment);
void checkDerived(const ExperimentSpec& experiment);
void checkCandidates(const ExperimentSpec& experiment);

}  // namespace twinmap
