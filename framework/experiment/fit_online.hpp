#pragma once

#include <string>
#include <vector>

#include "framework/experiment/prepare_data.hpp"
#include "framework/experiment/simulated_sets.hpp"
#include "framework/features/feature_extractor.hpp"
#include "framework/online/online_model.hpp"
#include "framework/store/maps_file.hpp"

namespace twinmap {

/// An online model; a note says why it has no trust model where it has none.
struct OnlineFit {
  OnlineModel model;
  StageNotes notes{};
};

/// Of how many simulated measurements a trust model's references are made: as fine as the map deserves.
int countReferences(int train_samples);

/// Compresses the map and fits its trust model: the forward model to the clean training responses, the
/// reference distributions to some 2000 simulated measurements (fewer below 200 training samples), the test
/// responses with noise drawn for that alone. Deterministic. Cost: some seconds at most.
OnlineFit fitOnline(const ExperimentSpec& experiment, const SimulatedSets& sets,
                    const FeatureExtractor& extractor, const LabelledSets& labelled, const GpMap& map);

/// All of maps.h5.
StoredMap makeStoredMap(const ExperimentSpec& experiment, const FeatureExtractor& extractor, const GpMap& map,
                        const OnlineModel& online);

}  // namespace twinmap
