#include "framework/experiment/files/tracking_file.hpp"

#include "framework/experiment/tree/read_value.hpp"
#include "framework/experiment/tree/write_value.hpp"

namespace twinmap {

std::optional<TrackingSpec> readTracking(const YamlNode& root) {
  const YamlNode* node = root.find(kTrackingKey);
  if (node == nullptr) {
    return {};
  }
  TrackingSpec tracking;
  readValue(*node, tracking);
  return tracking;
}

std::optional<TrackingSpec> loadTracking(const std::string& path) {
  return readTracking(loadYaml(path));
}

std::string writeTracking(const TrackingSpec& tracking) {
  return writeYaml(writeValue(tracking));
}

}  // namespace twinmap
