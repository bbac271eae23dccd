#pragma once

#include <filesystem>
#include <string>

#include "framework/serve/live/measurement_service.hpp"
#include "framework/tracking/track_session.hpp"

namespace twinmap::serve {

/// The twin of `twinmap track` behind the server.
class TrackService final : public MeasurementService {
 public:
  /// The source must outlive it. Throws as TrackSession.
  TrackService(const TwinSource& source, std::filesystem::path state, TrackOptions options);

  Json answer(const PostedMeasurement& posted) override;
  void commit() override;
  Json getState() const override;
  std::string makeHistory(std::size_t most) const override;
  std::string makePage() const override;

 private:
  TrackSession session_;
};

/// A time as it is posted: ISO 8601, or seconds since 1970. Throws ExperimentError.
double parseAt(const std::string& text);

}  // namespace twinmap::serve
