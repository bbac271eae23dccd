#include "framework/export/model/exported_tracking.hpp"

#include "framework/tracking/track_model.hpp"

namespace twinmap {

ExportedTracking makeExportedTracking(const std::optional<TrackingSpec>& tracking, const ModelSpec& model) {
  if (tracking) {
    checkTracking(*tracking, model);
  }
  const TrackSpace space(model.parameters);
  return {space, makeTrackPrior(model, space), makeTrackModel(tracking ? &*tracking : nullptr, model, space),
          tracking ? listConditions(*tracking) : std::vector<std::string>{}};
}

}  // namespace twinmap
