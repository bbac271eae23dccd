#include "framework/diagnosis/problem/sensor_faults.hpp"

#include <limits>

#include "framework/inference/select_estimate.hpp"

namespace twinmap {
namespace {

void leaveOutliers(const SimulatorFit& fit, Eigen::VectorXd& features) {
  for (const Eigen::Index feature : fit.outlier_features) {
    if (feature < features.size()) {
      features[feature] = std::numeric_limits<double>::quiet_NaN();
    }
  }
}

}  // namespace

void takeFaults(const SimulatorFit& fit, const TakenFaults& taken, std::size_t recording,
                RecordedFeatures& recordings) {
  leaveOutliers(fit, recordings.features[recording]);
  recordings.noise.resize(recordings.features.size());
  for (const NoiseReport& report : fit.noise) {
    const FoundNoise& found = report.found;
    if (!report.isStated() && !taken.unstated_sizes) {
      continue;
    }
    OutputNoise noise{found.output, found.factor, found.has_offset && taken.offsets};
    if (found.autoregression.size() > 0 && taken.colours) {
      noise.colours.push_back({found.autoregression});
    }
    if (found.factor != 1.0 || noise.has_offset || !noise.colours.empty()) {
      recordings.noise[recording].outputs.push_back(std::move(noise));
    }
  }
}

void takeFaults(const std::vector<RecordingInference>& alone, const TakenFaults& taken,
                RecordedFeatures& recordings) {
  for (std::size_t k = 0; k < alone.size(); ++k) {
    const SimulatorFit* fit = findFit(alone[k].inferred);
    if (fit != nullptr && fit->isPlausible()) {
      takeFaults(*fit, taken, k, recordings);
    } else if (fit != nullptr) {
      leaveOutliers(*fit, recordings.features[k]);
    }
  }
}

DiagnosedRecordings explainSensors(const JointInferrer& inferrer, const ExperimentSpec& experiment,
                                   const std::vector<Recording>& recordings,
                                   const std::vector<KnownValue>& known) {
  DiagnosedRecordings explained{readRecordings(experiment, recordings, known), {}, {}};
  std::vector<ExplainedRecording> alone = inferrer.explainAlone(recordings, JointInferrer::Misfits::kStarts);
  for (std::size_t k = 0; k < alone.size(); ++k) {
    explained.alone.push_back(
        {recordings[k].label, std::move(alone[k].inferred), std::move(alone[k].posterior)});
  }
  const bool offsets = alone.size() > 1;
  explained.coloured = explained.features;
  takeFaults(explained.alone, {offsets, false}, explained.features);
  takeFaults(explained.alone, {offsets, false, true}, explained.coloured);
  return explained;
}

}  // namespace twinmap
