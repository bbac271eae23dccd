#include "framework/experiment/files/tracking_file.hpp"

#include "framework/experiment/tree/read_value.hpp"
#include "framework/experiment/tree/write_value.hpp"

namespace twinmap {

std::optional<TrackingSpec> loadTracking(const std::string& path) {
  const YamlNode root = loadYaml(path);
  const YamlNode* node = root.find(kTrackingKey);
  if (node == nullptr) {
    return {};
  }
  TrackingSpec tracking;
  readValue(*node, tracking);
  return tracking;
}

std::string writeTracking(const TrackingSpec& tracking) {
  return writeYaml(writeValue(tracking));
}

}  // namespace twinmap
