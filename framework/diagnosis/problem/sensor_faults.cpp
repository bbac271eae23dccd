#include "framework/diagnosis/problem/sensor_faults.hpp"

#include <limits>

namespace twinmap {

void takeFaults(const SimulatorFit& fit, SensorFaults faults, std::size_t recording,
                RecordedFeatures& recordings) {
  Eigen::VectorXd& features = recordings.features[recording];
  for (const Eigen::Index feature : fit.outlier_features) {
    if (feature < features.size()) {
      features[feature] = std::numeric_limits<double>::quiet_NaN();
    }
  }
  recordings.noise.resize(recordings.features.size());
  for (const NoiseReport& report : fit.noise) {
    const FoundNoise& found = report.found;
    const bool has_offset = found.has_offset && faults == SensorFaults::kSizesAndOffsets;
    if (found.size_was_inferred || has_offset) {
      recordings.noise[recording].outputs.push_back({found.output, found.factor, has_offset});
    }
  }
}

}  // namespace twinmap
