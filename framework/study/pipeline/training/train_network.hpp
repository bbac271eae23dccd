#pragma once

#include <memory>

#include "framework/data/reduction/feature_transform.hpp"
#include "framework/estimation/network/network_map.hpp"
#include "framework/study/pipeline/training/train_surrogate_map.hpp"

namespace twinmap {

/// A trained network and how that went.
struct NetworkOutcome {
  NetworkMap map;
  FeatureTransform transform;  ///< what a linear regression is to see of the features
  TrainingSummary summary;     ///< its left-out samples are those of the network's validation
  StageNotes notes;
  std::shared_ptr<const ForwardSurrogate> forward;  ///< where it learnt from a surrogate; else null
};

/// Trains the experiment's network. samples_from: automatic takes a surrogate, trained first, where it can be
/// and the simulations are at most the 2000 that one takes; the log says which. A network whose standard
/// deviations are more than 1.1 times those of the surrogate that taught it is trained again, for longer
/// (NetworkSize). Throws Interrupted if it is stopped, std::runtime_error where the experiment does not fit
/// it.
NetworkOutcome trainNetwork(const Study& study, const PreparedData& data);

}  // namespace twinmap
