#pragma once

#include <functional>
#include <optional>

#include "framework/inference/measurement/measurement_inference.hpp"
#include "framework/tracking/change_windows.hpp"
#include "framework/tracking/recording_shelf.hpp"

namespace twinmap {

/// What the recordings of a trial's measurements are read and inferred by.
struct ChangeRecorder {
  MeasurementInference& inference;
  const Eigen::VectorXd& known;                                      ///< of the inputs
  std::function<std::optional<KeptTable>(const TrackRecord&)> find;  ///< none: it is not at hand any more
};

/// Holds an alarm against terms that the model may lack (weighChangeOrTerm()), of the recordings that are at
/// hand. The diagnosis says so in words where there are none of one side, or the model's terms are not known.
/// Cost: that of twelve inferences and of weighChangeOrTerm().
AlarmDiagnosis diagnoseAlarm(const TrackAlarm& alarm, const ChangeWindows& windows,
                             const ChangeRecorder& recorder);

}  // namespace twinmap
