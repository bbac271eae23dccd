#pragma once

#include "framework/experiment/tracking_spec.hpp"
#include "framework/tracking/track_space.hpp"
#include "kernels/tracking/model.hpp"

namespace twinmap {

/// The columns of conditions, each once, in the order in which `follows` names them.
std::vector<std::string> listConditions(const TrackingSpec& tracking);

/// The linear model of the tracked parameters. Without a section `tracking` (checked) all walk at unknown
/// rates. The error is that of an estimator that is not refined (OnlineModel), else empty.
tracking::Model makeTrackModel(const TrackingSpec* tracking, const ModelSpec& model, const TrackSpace& space,
                               const Eigen::VectorXd& shared_error);

}  // namespace twinmap
