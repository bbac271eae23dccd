#include "framework/inference/direct_inference.hpp"

#include "framework/base/text/source_location.hpp"

namespace twinmap {

DirectInference::DirectInference(const MeasurementReader& reader, int draws)
    : reader_(reader),
      simulator_(reader.getExperiment(), reader.getLayout(), SimulatorRefiner::Model::kToBeChecked),
      options_(makePosteriorOptions(reader.getExperiment(), draws)) {
  simulator_.requireNoise();
}

InferredMeasurement DirectInference::infer(const Eigen::VectorXd& features, const Eigen::VectorXd& known) {
  InferredMeasurement inferred;
  inferred.posterior = simulator_.samplePosterior(features, known, {}, options_);
  return inferred;
}

}  // namespace twinmap
