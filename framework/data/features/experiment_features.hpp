#pragma once

#include "framework/data/features/feature_extractor.hpp"
#include "framework/experiment/experiment_spec.hpp"

namespace twinmap {

/// What the rows of a response are, for the features of an experiment.
ResponseLayout makeLayout(const ExperimentSpec& experiment);

/// The features of an experiment for responses of a layout; the excitation is computed where they need it.
/// Throws ExperimentError for a frequency response where the excitation has no energy.
FeatureExtractor makeExtractor(const ExperimentSpec& experiment, const ResponseLayout& layout);

}  // namespace twinmap
