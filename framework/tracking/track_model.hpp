#pragma once

#include "framework/experiment/tracking_spec.hpp"
#include "framework/tracking/track_space.hpp"
#include "kernels/tracking/model.hpp"

namespace twinmap {

/// The columns of conditions, each once, in the order in which `follows` names them.
std::vector<std::string> listConditions(const TrackingSpec& tracking);

/// The linear model of the tracked parameters. tracking: checked; null: all walk at unknown rates.
tracking::Model makeTrackModel(const TrackingSpec* tracking, const ModelSpec& model, const TrackSpace& space);

}  // namespace twinmap
