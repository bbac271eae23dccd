#pragma once

#include "framework/features/feature_extractor.hpp"
#include "framework/features/feature_noise.hpp"
#include "framework/features/labelled_features.hpp"
#include "framework/simulated_sets.hpp"

namespace twinmap {

/// The samples as the inverse map sees them: features of noisy responses, with their parameters.
struct LabelledSets {
  LabelledFeatures train, test;
};

/// Draws the noise of both sets: `noise.replicates` draws for every training sample, one for every test
/// sample. Samples that failed are left out.
LabelledSets makeLabelledSets(const ExperimentSpec& experiment, const SimulatedSets& sets,
                              const FeatureExtractor& extractor, const FeatureNoise& noise);

}  // namespace twinmap
