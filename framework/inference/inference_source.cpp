#include "framework/inference/inference_source.hpp"

#include "framework/base/text/source_location.hpp"
#include "framework/data/measurement/signal_experiment.hpp"
#include "framework/experiment/experiment_file.hpp"
#include "framework/inference/direct_inference.hpp"
#include "framework/inference/tolerances/tolerances.hpp"

namespace twinmap {
namespace {

/// An experiment's file; anything else is a run.
bool isExperimentFile(const std::filesystem::path& path) {
  return path.extension() == ".yaml" || path.extension() == ".yml";
}

std::unique_ptr<MeasurementInference> makeDirect(const MeasurementReader& reader,
                                                 const SessionOptions& options) {
  if (options.refine) {
    throw ExperimentError(
        "an experiment file is inferred by simulation alone: there is nothing to refine; leave --refine and "
        "--no-refine out, or give the folder of a run");
  }
  if (options.posterior_from == PosteriorSource::kSurrogate) {
    throw ExperimentError(
        "an experiment file is inferred by simulation alone: there is no surrogate; leave --posterior-from "
        "out, or give the folder of a run");
  }
  return std::make_unique<DirectInference>(
      reader, options.posterior_draws > 0 ? options.posterior_draws : SimulatorPosteriorOptions{}.draws);
}

}  // namespace

InferenceSource::InferenceSource(const std::filesystem::path& run_or_experiment) {
  if (isExperimentFile(run_or_experiment)) {
    reader_.emplace(followNoise(readExperimentWithSignals(loadExperimentTree(run_or_experiment))));
  } else {
    trained_.emplace(run_or_experiment);
  }
}

InferenceSource::InferenceSource(ExperimentSpec experiment) : reader_(followNoise(std::move(experiment))) {}

std::unique_ptr<MeasurementInference> InferenceSource::makeSession(const SessionOptions& options) const {
  if (trained_) {
    return std::make_unique<MeasurementSession>(*trained_, options);
  }
  return makeDirect(*reader_, options);
}

}  // namespace twinmap
