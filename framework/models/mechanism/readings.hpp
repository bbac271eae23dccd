#pragma once

#include <algorithm>

#include "framework/experiment/model/model_spec.hpp"
#include "framework/simulation/response_layout.hpp"

namespace twinmap {

/// The range of the sensor that shows a row of a response; null where it has none.
inline const Bounds* findRange(const ModelSpec& model, const ResponseLayout& layout, Eigen::Index row) {
  const Eigen::Index output = layout.times.size() == 0 ? layout.getOutputCount() : row / layout.times.size();
  if (output >= layout.getOutputCount()) {
    return nullptr;
  }
  const std::optional<SensorSpec>& sensor = model.outputs[static_cast<std::size_t>(output)].sensor;
  return sensor && sensor->range ? &*sensor->range : nullptr;
}

/// Whether it shows an end of its range, where it does not follow what it measures.
inline bool isClipped(const Bounds& range, double reading) {
  return reading <= range.lower || reading >= range.upper;
}

/// Quantities to what sensors of limited range show of them.
inline void clipReadings(const ModelSpec& model, const ResponseLayout& layout,
                         Eigen::Ref<Eigen::VectorXd> response) {
  const Eigen::Index times = layout.times.size();
  for (Eigen::Index output = 0; output < layout.getOutputCount() && times > 0; ++output) {
    if (const Bounds* range = findRange(model, layout, output * times)) {
      for (double& reading : response.segment(output * times, times)) {
        reading = std::clamp(reading, range->lower, range->upper);
      }
    }
  }
}

}  // namespace twinmap
