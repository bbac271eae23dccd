#include "framework/study/pipeline/run_experiment.hpp"

#include <fmt/core.h>

#include "framework/base/files/atomic_file.hpp"
#include "framework/base/files/folder_lock.hpp"
#include "framework/base/log/log.hpp"
#include "framework/base/log/run_control.hpp"
#include "framework/base/log/stage_timer.hpp"
#include "framework/data/reduction/selections.hpp"
#include "framework/experiment/experiment_file.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/experiment/resolve_defaults.hpp"
#include "framework/models/make_simulator.hpp"
#include "framework/report/report.hpp"
#include "framework/results/result_files.hpp"
#include "framework/results/run_state.hpp"
#include "framework/results/tables.hpp"
#include "framework/store/samples_file.hpp"
#include "framework/study/pipeline/evaluate_map.hpp"
#include "framework/study/pipeline/example_responses.hpp"
#include "framework/study/pipeline/online_timing.hpp"
#include "framework/study/pipeline/prepare_data.hpp"
#include "framework/study/pipeline/simulated_sets.hpp"
#include "framework/study/pipeline/training/choose_samples.hpp"
#include "framework/study/pipeline/training/compare_maps.hpp"
#include "framework/study/pipeline/training/store_map.hpp"
#include "framework/study/pipeline/training/train_maps.hpp"
#include "framework/study/pipeline/trust/trust_power.hpp"
#include "framework/study/samples/ineffective_parameters.hpp"
#include "framework/study/samples/model_store.hpp"
#include "framework/study/samples/stencils.hpp"

namespace twinmap {
namespace {

namespace fs = std::filesystem;

/// The run's own stores; none where its samples are shared.
struct OwnStores {
  std::unique_ptr<TrajectoryStore> samples, stencils;
};

OwnStores openOwnStores(const ExperimentSpec& experiment, const Simulator& simulator,
                        const RunOptions& options) {
  if (options.samples != nullptr) {
    return {};
  }
  const fs::path root = getStoreRoot(options.folder, options.store);
  OwnStores stores{openStore(experiment.model, simulator.getLayout(), root), nullptr};
  if (!simulator.hasDerivatives() && listDerivativePoints(experiment).cols() > 0) {
    stores.stencils = openStencilStore(experiment.model, simulator.getLayout(), root);
  }
  return stores;
}

/// Takes the folder over for the experiment, or throws.
void beginFolder(const ExperimentSpec& experiment, const RunOptions& options) {
  const std::string resolved = writeExperiment(experiment);
  requireSameExperiment(options.folder, resolved);
  beginRun(options.folder, resolved);
  if (options.samples == nullptr) {
    noteStore(options.folder, options.store);
  }
}

/// Where derivatives are differences of noisy responses.
void logFiniteDifferenceSteps(const ExperimentSpec& experiment, Simulator& simulator) {
  if (!simulator.hasDerivatives() && listDerivativePoints(experiment).cols() > 0) {
    if (const std::string text = simulator.describeDifferences(); !text.empty()) {
      logInfo(text);
    }
  }
}

/// A model from elsewhere may ignore a name.
void warnOfIneffective(const ModelSpec& model, const Simulator& simulator) {
  const std::string warning =
      model.source ? describeIneffective(findIneffective(simulator, collectSampled(model))) : "";
  if (!warning.empty()) {
    logWarning(warning);
  }
}

/// What the stages of a run work with.
struct RunContext {
  const ExperimentSpec& experiment;
  const Simulator& simulator;
  const FeatureExtractor& extractor;
  const SampleSource& source;
  const fs::path& folder;
  const RunControl& control;
};

LocalModelSource makeLocalModelSource(const RunContext& run) {
  return [run](const Eigen::MatrixXd& points) {
    return calcLocalModels(run.experiment, run.source, run.simulator, run.extractor, points,
                           run.control.threads);
  };
}

/// The samples of a run, and those of them that failed.
struct Samples {
  SimulatedSets sets;
  std::vector<FailedSample> failures;
};

/// Simulates what is missing, writes samples.h5 and failures.csv, and throws where too many samples failed.
Samples simulateSamples(const RunContext& run) {
  const ExperimentSpec& experiment = run.experiment;
  SimulatedSets sets = simulateSets(experiment, run.source, run.simulator.getLayout(), run.control);
  writeSamplesFile(run.folder / "samples.h5", experiment.model, sets.train, sets.test);
  sets = failIncompleteSamples(experiment, run.extractor, std::move(sets));
  std::vector<FailedSample> failures = listFailures(sets);
  const fs::path file = run.folder / "failures.csv";
  writeTextFile(file, makeFailuresCsv(collectSampled(experiment.model), failures));
  requireFewFailures(experiment, failures, file);
  sets.notes.append(simulateStencils(experiment, run.source, run.control));
  return {std::move(sets), std::move(failures)};
}

/// Writes trust_power.csv: what the trust model finds.
StageNotes writeTrustPower(const RunContext& run, const Samples& samples, const PreparedData& data,
                           const TrainedMap& trained) {
  StageNotes notes;
  throwIfCancelled(run.control);
  if (!trained.online.trust) {
    return notes;
  }
  const auto changes = timeStage("power of the trust status", notes, [&] {
    return calcTrustPower({run.experiment, samples.sets, run.extractor, data.labelled.train.noise_covariance,
                           trained.online, run.control.threads});
  });
  notes.warn(Severity::kDegraded, listPowerWarnings(changes));
  writeTextFile(run.folder / "trust_power.csv", makeTrustPowerCsv(changes));
  return notes;
}

/// Writes responses.csv: the models of a few test samples beside what was measured.
StageNotes writeExamples(const RunContext& run, const Trajectories& test,
                         const std::vector<int>& test_indices, const Evaluation& evaluation) {
  StageNotes notes;
  throwIfCancelled(run.control);
  const std::vector<ExampleResponse> examples = timeStage("simulate updated models", notes, [&] {
    return simulateExamples(run.experiment, run.simulator, test, test_indices, evaluation,
                            run.control.threads);
  });
  writeTextFile(run.folder / "responses.csv",
                makeResponsesCsv(examples, test.layout, calcNoiseStddev(run.experiment.noise, test.layout)));
  return notes;
}

/// How many training samples are taken, and what was found out about it.
SampleChoice chooseSamples(const RunContext& run, const RunOptions& options) {
  const SampleCount& asked = run.experiment.design.train.samples;
  const fs::path recorded = run.folder / "samples.h5";
  if (!asked.automatic || options.train_samples > 0) {
    return {asked.automatic ? options.train_samples : asked.number, 0, {}, {}};
  }
  if (fs::exists(recorded)) {
    return {countTrainingSamples(recorded), 0, {}, {}};
  }
  const int most = options.samples != nullptr ? asked.number  // a sweep has limited it
                                              : limitByTime(run.experiment, *run.simulator.clone());
  const LocalModelSource local_models = makeLocalModelSource(run);
  return chooseTrainingSamples(
      {run.experiment, run.simulator, run.extractor, run.source, local_models, run.control}, most);
}

/// The map of the choice where that was trained, else a new one.
TrainedMap trainOrTake(const MapTrainingContext& context, SampleChoice& choice) {
  return choice.training ? makeTrainedMap(context, std::move(*choice.training)) : trainChosenMap(context);
}

/// The stages of a run, one after the other.
RunSummary runStages(const RunContext& run, SampleChoice choice) {
  const ExperimentSpec& experiment = run.experiment;
  const LocalModelSource local_models = makeLocalModelSource(run);
  const Samples samples = simulateSamples(run);
  const PreparedData data = prepareData(experiment, run.extractor, samples.sets, local_models);
  const MapTrainingContext training{experiment,    samples.sets,  run.simulator,
                                    run.extractor, data.labelled, run.control};
  TrainedMap trained = trainOrTake(training, choice);
  MapEvaluation evaluated =
      evaluateMap({experiment, run.simulator, run.extractor, data, trained, local_models, run.control});
  ComparedMaps compared = compareMaps({training, evaluated.evaluation.limit_stddev, run.folder});
  evaluated.evaluation.maps = std::move(compared.maps);
  evaluated.notes.append(compared.notes);
  storeMap(run.folder / "maps.h5", experiment, run.extractor, evaluated.evaluation.refined, trained);
  evaluated.notes.append(writeTrustPower(run, samples, data, trained));

  RunSummary summary;
  summary.parameters = experiment.model.parameters;
  summary.test_indices = data.test_indices;
  summary.training = trained.summary;
  summary.evaluation = evaluated.evaluation;
  summary.failures = samples.failures;
  summary.reused_samples = samples.sets.reused - choice.simulated;
  for (const StageNotes& notes : {choice.notes, samples.sets.notes, trained.notes, evaluated.notes}) {
    summary.notes.append(notes);
  }
  summary.notes.append(writeExamples(run, samples.sets.test, data.test_indices, evaluated.evaluation));
  summary.online = timeStage("time the inference of one measurement", summary.notes,
                             [&] { return timeOnlineUpdates(trained.online, data.labelled.test); });
  return summary;
}

/// Writes the tables, then provenance.json, then the report from all of them; returns its gates.
std::vector<GateResult> writeFolder(const ExperimentSpec& experiment, const RunOptions& options, int threads,
                                    const RunSummary& run) {
  writeResults(options.folder, run);
  Provenance provenance;
  provenance.command = options.command;
  provenance.seed = experiment.seed;
  provenance.threads = threads;
  writeProvenance(options.folder, provenance, run);
  const Report report = makeReport({options.folder});
  writeReport(options.folder, report);
  return report.gates;
}

}  // namespace

RunSummary runExperiment(const ExperimentSpec& experiment, const RunOptions& options,
                         const RunControl& control) {
  makeFolders(options.folder);
  const FolderLock lock(options.folder);
  beginFolder(experiment, options);
  const std::unique_ptr<RunLog> log = options.samples ? nullptr : std::make_unique<RunLog>(options.folder);

  const std::unique_ptr<Simulator> made =
      makeSimulator(experiment.model, collectTimes(experiment.features), countModes(experiment.features));
  const Simulator& simulator = *made;
  logInfo(fmt::format("simulated by: {}", simulator.getEngine()));
  if (options.samples == nullptr) {
    warnOfIneffective(experiment.model, simulator);
    logFiniteDifferenceSteps(experiment, *made);
  }
  const FeatureExtractor extractor = makeExtractor(experiment, simulator.getLayout());
  checkTransformOf(extractor.getInfos(), experiment.transform);
  const OwnStores stores = openOwnStores(experiment, simulator, options);
  const SampleSource source =
      options.samples ? *options.samples : SampleSource{simulator, *stores.samples, stores.stencils.get()};

  const RunContext asked{experiment, simulator, extractor, source, options.folder, control};
  SampleChoice choice = chooseSamples(asked, options);
  const ExperimentSpec chosen = experiment.design.train.samples.automatic
                                    ? takeTrainingSamples(experiment, choice.samples)
                                    : experiment;
  RunSummary run =
      runStages({chosen, simulator, extractor, source, options.folder, control}, std::move(choice));
  throwIfCancelled(control);
  run.gates = writeFolder(experiment, options, control.threads, run);
  return run;
}

}  // namespace twinmap
