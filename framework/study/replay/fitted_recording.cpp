#include "framework/study/replay/fitted_recording.hpp"

#include <memory>

#include "framework/data/noise/noise.hpp"
#include "framework/inference/select_estimate.hpp"
#include "framework/models/make_simulator.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

VectorXd findNoise(const ExperimentSpec& experiment, const ResponseLayout& layout,
                   const InferredMeasurement& inferred) {
  VectorXd stddev = calcNoiseStddev(experiment.noise, layout);
  if (!inferred.posterior || !inferred.posterior->fit) {
    return stddev;
  }
  for (const NoiseReport& report : inferred.posterior->fit->noise) {
    for (Index output = 0; output < layout.getOutputCount(); ++output) {
      if (!report.isStated() && layout.output_names[static_cast<std::size_t>(output)] == report.output) {
        stddev.segment(layout.getRow(output, 0), layout.times.size()).setConstant(report.stddev);
      }
    }
  }
  return stddev;
}

}  // namespace

std::optional<ShownRecording> fitRecording(const MeasurementReader& reader, const Table& table,
                                           std::optional<double> start, const VectorXd& known,
                                           const InferredMeasurement& inferred, const std::string& id) {
  const VectorXd point = findExplanation(inferred, known);
  if (point.size() == 0 || reader.findReduction() != nullptr || !inferred.clock_faults.empty()) {
    return std::nullopt;
  }
  std::optional<ExperimentSpec> followed = reader.follow(table, start);
  const MeasurementReader like(followed ? std::move(*followed) : reader.getExperiment());
  const ResponseLayout& layout = like.getLayout();
  if (layout.times.size() == 0) {
    return std::nullopt;
  }
  const std::unique_ptr<Simulator> simulator =
      makeSimulator(like.getExperiment().model, layout.times, layout.modes);
  Eigen::MatrixXd response(layout.getRowCount(), 1);
  SampleStatus status;
  simulator->simulate(point, response, &status);
  if (!status.ok) {
    return std::nullopt;
  }
  return ShownRecording{id, layout, like.readAvailableFeatures(table, start).response,
                        findNoise(like.getExperiment(), layout, inferred), response.col(0)};
}

}  // namespace twinmap
