#pragma once

#include "framework/experiment/simulated_sets.hpp"
#include "framework/features/feature_extractor.hpp"
#include "framework/features/feature_noise.hpp"
#include "framework/features/labelled_features.hpp"
#include "framework/sensitivity/feature_sensitivities.hpp"

namespace twinmap {

/// The samples as the inverse map sees them: features of noisy responses, with their parameters.
struct LabelledSets {
  LabelledFeatures train, test;
};

/// Fails the samples whose response lacks a feature, such as a third peak: the clean response, which stands
/// for the sample where sensitivities and noise are computed, or one of its noisy draws. Training samples
/// drop out with all their draws, so that every sample weighs the same.
void failIncompleteSamples(const ExperimentSpec& experiment, const FeatureExtractor& extractor,
                           SimulatedSets& sets);

/// Draws the noise of both sets: `noise.replicates` draws for every training sample, one for every test
/// sample. Samples that failed are left out.
LabelledSets makeLabelledSets(const ExperimentSpec& experiment, const SimulatedSets& sets,
                              const FeatureExtractor& extractor, const FeatureNoise& noise);

/// For a transform that selects by Fisher information, the sensitivities at the first 16 training samples
/// that could be simulated; else none. Throws std::runtime_error if they fail at every one of them.
std::vector<Eigen::MatrixXd> calcTrainingSensitivities(const ExperimentSpec& experiment,
                                                       const Trajectories& train,
                                                       const LocalModelSource& local_models);

}  // namespace twinmap
