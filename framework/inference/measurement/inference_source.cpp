#include "framework/inference/measurement/inference_source.hpp"

#include "framework/base/text/source_location.hpp"
#include "framework/data/measurement/files/read_table.hpp"
#include "framework/data/measurement/files/table.hpp"
#include "framework/data/measurement/signal_experiment.hpp"
#include "framework/experiment/files/experiment_file.hpp"
#include "framework/experiment/trials/trial_trees.hpp"
#include "framework/inference/measurement/direct_inference.hpp"
#include "framework/inference/tolerances/tolerances.hpp"

namespace twinmap {
namespace {

/// The file of the experiment that is inferred by without a map: the path itself, or that of a run with
/// `inverse_map: none`; empty for a run with a map. A file that is not a trained one is taken for an
/// experiment, whose reader says what it is instead.
std::filesystem::path findExperiment(const std::filesystem::path& path) {
  const bool is_yaml = path.extension() == ".yaml" || path.extension() == ".yml";
  if (is_yaml || (std::filesystem::is_regular_file(path) && path.extension() != ".h5")) {
    return path;
  }
  const std::filesystem::path resolved = path / "resolved.yaml";
  const bool has_no_map = std::filesystem::exists(resolved) && !std::filesystem::exists(path / "maps.h5") &&
                          loadExperiment(resolved.string()).inverse_map.isNone();
  return has_no_map ? resolved : std::filesystem::path();
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
      reader, options.posterior_draws > 0 ? options.posterior_draws : SimulatorPosteriorOptions{}.draws,
      SimulatorRefiner::Model::kToBeChecked, options.profiles);
}

}  // namespace

InferenceSource::InferenceSource(const std::filesystem::path& run_or_experiment) {
  refuseRecording(run_or_experiment);
  if (const std::filesystem::path experiment = findExperiment(run_or_experiment); !experiment.empty()) {
    reader_.emplace(followNoise(readExperimentWithSignals(loadExperimentTree(experiment.string()))));
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

InferenceSource readAllTrials(const std::filesystem::path& experiment) {
  return InferenceSource(readExperimentWithSignals(selectAllTrials(loadExperimentTree(experiment.string()))));
}

}  // namespace twinmap
