#pragma once

#include "framework/data/features/labelled_features.hpp"
#include "framework/study/pipeline/preparation/simulated_sets.hpp"
#include "framework/study/pipeline/preparation/study.hpp"

namespace twinmap {

/// The samples as the inverse map sees them: features of noisy responses, with their parameters.
struct LabelledSets {
  LabelledFeatures train, test;
};

/// What the training and the evaluation of a map look at.
struct PreparedData {
  SimulatedSets sets;
  LabelledSets labelled;
  std::vector<int> test_indices;  ///< test samples that did not fail: columns of labelled.test
};

/// The sets, with the samples failed whose response lacks a feature, such as a third peak: the clean
/// response, which stands for the sample where sensitivities and noise are computed, or one of its noisy
/// draws. Training samples drop out with all their draws, so that every sample weighs the same.
SimulatedSets failIncompleteSamples(const ExperimentSpec& experiment, const FeatureExtractor& extractor,
                                    SimulatedSets sets);

/// Draws the noise of both sets: `noise.replicates` draws for every training sample, one for every test
/// sample. Samples that failed are left out.
LabelledSets makeLabelledSets(const ExperimentSpec& experiment, const SimulatedSets& sets,
                              const FeatureExtractor& extractor, const FeatureNoise& noise);

/// From simulated sets (failIncompleteSamples) to what a map is trained on. For a transform that selects by
/// Fisher information, the training features carry the sensitivities at the first kSensitivitySamples
/// training samples that could be simulated. Throws std::runtime_error if the sensitivities fail at every one
/// of them.
PreparedData prepareData(const Study& study, SimulatedSets sets);

}  // namespace twinmap
