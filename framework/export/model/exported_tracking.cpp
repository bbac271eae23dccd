#include "framework/export/model/exported_tracking.hpp"

#include "framework/tracking/track_model.hpp"

namespace twinmap {

ExportedTracking makeExportedTracking(const std::optional<TrackingSpec>& tracking,
                                      const ExportedModel& model) {
  const ModelSpec& machine = model.experiment.model;
  if (tracking) {
    checkTracking(*tracking, machine);
  }
  const TrackSpace space(machine.parameters);
  return {space, makeTrackPrior(machine, space),
          makeTrackModel(tracking ? &*tracking : nullptr, machine, space, model.online.shared_error),
          tracking ? listConditions(*tracking) : std::vector<std::string>{}};
}

}  // namespace twinmap
