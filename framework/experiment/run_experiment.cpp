#include "framework/experiment/run_experiment.hpp"

#include <algorithm>

#include "framework/experiment/evaluate_map.hpp"
#include "framework/experiment/example_responses.hpp"
#include "framework/experiment/fit_online.hpp"
#include "framework/experiment/labelled_sets.hpp"
#include "framework/experiment/make_extractor.hpp"
#include "framework/experiment/online_timing.hpp"
#include "framework/features/noise.hpp"
#include "framework/features/selections.hpp"
#include "framework/inverse_map/train_gp_map.hpp"
#include "framework/monitoring/run_log.hpp"
#include "framework/monitoring/stage_timer.hpp"
#include "framework/multibody/multibody_simulator.hpp"
#include "framework/report/report.hpp"
#include "framework/results/result_files.hpp"
#include "framework/results/run_state.hpp"
#include "framework/sampling/needed_neighbourhoods.hpp"
#include "framework/sampling/stored_local_models.hpp"
#include "framework/spec/check/check_experiment.hpp"
#include "framework/spec/experiment_file.hpp"
#include "framework/spec/parameter_box.hpp"
#include "framework/store/atomic_file.hpp"
#include "framework/store/folder_lock.hpp"
#include "framework/store/maps_file.hpp"

namespace twinmap {
namespace {

namespace fs = std::filesystem;

RunSummary startSummary(const ExperimentSpec& experiment) {
  RunSummary run;
  run.name = experiment.name.text;
  run.description = experiment.description;
  run.parameters = experiment.model.parameters;
  run.sampled = collectSampled(experiment.model);
  run.train_samples = experiment.design.train.samples;
  run.test_samples = experiment.design.test.samples;
  const std::vector<std::string> names = collectNames(experiment.model.parameters);
  for (const Name& axis : experiment.report.over) {
    run.axes.push_back(static_cast<int>(std::find(names.begin(), names.end(), axis.text) - names.begin()));
  }
  return run;
}

std::string join(const std::vector<std::string>& texts) {
  std::string joined;
  for (const std::string& text : texts) {
    joined += (joined.empty() ? "" : "; ") + text;
  }
  return joined;
}

std::vector<TrainingStart> summarizeTraining(const std::vector<std::string>& parameters,
                                             const std::vector<gp::TrainingReport>& reports) {
  std::vector<TrainingStart> rows;
  for (std::size_t p = 0; p < reports.size(); ++p) {
    for (std::size_t k = 0; k < reports[p].starts.size(); ++k) {
      const gp::StartReport& start = reports[p].starts[k];
      const bool best = static_cast<int>(k) == reports[p].best_start;
      rows.push_back({parameters[p], static_cast<int>(k), best, start.nlml, start.evaluations,
                      start.noise_only, start.stop_reason, best ? join(reports[p].at_bound) : "",
                      reports[p].condition, reports[p].jitter});
    }
  }
  return rows;
}

std::vector<TrainedHyperparameter> listHyperparameters(const std::vector<std::string>& parameters,
                                                       const std::vector<gp::TrainingReport>& reports) {
  std::vector<TrainedHyperparameter> listed;
  for (std::size_t p = 0; p < reports.size(); ++p) {
    for (const gp::BoundedHyperparameter& of : reports[p].hyperparameters) {
      listed.push_back({parameters[p], of.name, of.value, of.lower, of.upper});
    }
  }
  return listed;
}

/// The store where the options say; none if the samples are shared.
std::unique_ptr<TrajectoryStore> openOwnStore(const ExperimentSpec& experiment, const Simulator& simulator,
                                              const RunOptions& options) {
  if (options.samples != nullptr) {
    return nullptr;
  }
  return openStore(experiment.model, simulator.getLayout(), getStoreRoot(options.folder, options.store));
}

/// The store of the neighbourhoods that the experiment needs; none if the samples are shared.
std::unique_ptr<TrajectoryStore> openOwnNeighbourhoods(const ExperimentSpec& experiment,
                                                       const Simulator& simulator,
                                                       const RunOptions& options) {
  if (options.samples != nullptr || listNeededNeighbourhoods(experiment).cols() == 0) {
    return nullptr;
  }
  return openNeighbourhoodStore(experiment.model, simulator.getLayout(),
                                getStoreRoot(options.folder, options.store));
}

/// From the source's neighbourhoods, where it keeps them.
std::vector<LocalModel> getLocalModels(const ExperimentSpec& experiment, const SampleSource& source,
                                       const Simulator& simulator, const FeatureExtractor& extractor,
                                       const Eigen::MatrixXd& points, int threads) {
  const std::vector<ParameterSpec> unknown = collectUnknown(experiment.model);
  return source.neighbourhoods == nullptr
             ? calcLocalModels(simulator, extractor, unknown, points, threads)
             : calcStoredLocalModels(source, simulator.getLayout(), extractor, unknown, points, threads);
}

/// Trains the map on the training samples.
GpMap trainMap(const ExperimentSpec& experiment, const LabelledFeatures& training, const RunOptions& options,
               RunSummary& run) {
  const std::vector<std::string> parameter_names = collectNames(experiment.model.parameters);
  const GpMapTraining trained = timeStage("train the inverse map", run.times, [&] {
    return trainGpMap(experiment.inverse_map.gp, experiment.transform, parameter_names, training,
                      {options.threads}, experiment.model.inputs);
  });
  run.warnings = trained.warnings;
  run.leave_one_out = calcMetrics(experiment.model.parameters, training.parameters, trained.leave_one_out, {},
                                  training.replicates);
  run.training = summarizeTraining(parameter_names, trained.reports);
  run.hyperparameters = listHyperparameters(parameter_names, trained.reports);
  for (const gp::Process& process : trained.map.processes) {
    run.nlml.push_back(gp::getNlml(process));
  }
  return trained.map;
}

/// Makes the map ready for measurements and writes both.
OnlineModel writeMaps(const ExperimentSpec& experiment, const SimulatedSets& sets,
                      const FeatureExtractor& extractor, const LabelledSets& labelled, const GpMap& map,
                      const RunOptions& options, RunSummary& run) {
  const OnlineFit online = timeStage("prepare for measurements", run.times,
                                     [&] { return fitOnline(experiment, sets, extractor, labelled, map); });
  run.warnings.insert(run.warnings.end(), online.warnings.begin(), online.warnings.end());
  writeMapsFile(options.folder / "maps.h5", makeStoredMap(experiment, extractor, map, online.model));
  return online.model;
}

}  // namespace

RunSummary runExperiment(const ExperimentSpec& experiment, const RunOptions& options) {
  RunSummary run = startSummary(experiment);
  makeFolders(options.folder);
  const FolderLock lock(options.folder);
  const std::string resolved = writeExperiment(experiment);
  requireSameExperiment(options.folder, resolved);
  beginRun(options.folder, resolved);
  if (options.samples == nullptr) {
    noteStore(options.folder, options.store);
  }
  const std::unique_ptr<RunLog> log = options.samples ? nullptr : std::make_unique<RunLog>(options.folder);

  const MultibodySimulator simulator(experiment.model, collectTimes(experiment.features),
                                     countModes(experiment.features));
  const FeatureExtractor extractor = makeExtractor(experiment, simulator.getLayout());
  checkTransformOf(extractor.getInfos(), experiment.transform);
  const auto store = openOwnStore(experiment, simulator, options);
  const auto neighbourhoods = openOwnNeighbourhoods(experiment, simulator, options);
  const SampleSource source =
      store ? SampleSource{simulator, *store, neighbourhoods.get()} : *options.samples;
  SimulatedSets sets = simulateSets(experiment, source, simulator.getLayout(), options, run);
  failIncompleteSamples(experiment, extractor, sets);
  recordFailures(experiment, sets, options, run);
  run.test_indices = findSuccessful(sets.test);
  simulateNeighbourhoods(experiment, source, options, run);
  const LocalModelSource local_models = [&](const Eigen::MatrixXd& points) {
    return getLocalModels(experiment, source, simulator, extractor, points, options.threads);
  };

  const FeatureNoise noise(extractor, ResponseNoise(experiment.noise, simulator.getLayout()),
                           experiment.seed);
  LabelledSets labelled = makeLabelledSets(experiment, sets, extractor, noise);
  labelled.train.sensitivities = calcTrainingSensitivities(experiment, sets.train, local_models);

  const GpMap map = trainMap(experiment, labelled.train, options, run);
  const OnlineModel online = writeMaps(experiment, sets, extractor, labelled, map, options, run);
  const std::vector<ParameterSpec> unknown = collectUnknown(experiment.model);
  evaluate({experiment, unknown, simulator, extractor, noise, labelled, map, local_models, options.threads},
           run);
  writeExampleResponses(experiment, sets, simulator, options, run);
  run.online = timeStage("time the inference of one measurement", run.times,
                         [&] { return timeOnlineUpdates(online, labelled.test); });

  writeResults(options.folder, run);
  writeProvenance(experiment, options, run);
  const Report report = makeReport({options.folder});
  writeReport(options.folder, report);
  run.gates = report.gates;
  return run;
}

}  // namespace twinmap
