#include "framework/study/pipeline/run_experiment.hpp"

#include <fmt/core.h>

#include <limits>

#include "framework/base/files/atomic_file.hpp"
#include "framework/base/files/folder_lock.hpp"
#include "framework/base/log/log.hpp"
#include "framework/base/log/stage_timer.hpp"
#include "framework/data/features/experiment_features.hpp"
#include "framework/data/reduction/reduced_simulator.hpp"
#include "framework/data/reduction/selections.hpp"
#include "framework/data/sensitivity/fit_reduction.hpp"
#include "framework/experiment/check/check_noise.hpp"
#include "framework/experiment/files/experiment_file.hpp"
#include "framework/experiment/files/resolve_defaults.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/inference/tolerances/tolerances.hpp"
#include "framework/models/make_simulator.hpp"
#include "framework/report/sections/report.hpp"
#include "framework/results/result_files.hpp"
#include "framework/results/run_state.hpp"
#include "framework/results/tables.hpp"
#include "framework/store/samples_file.hpp"
#include "framework/study/pipeline/compare_maps.hpp"
#include "framework/study/pipeline/evaluate_map.hpp"
#include "framework/study/pipeline/example_responses.hpp"
#include "framework/study/pipeline/online_timing.hpp"
#include "framework/study/pipeline/preparation/prepare_data.hpp"
#include "framework/study/pipeline/preparation/simulated_sets.hpp"
#include "framework/study/pipeline/training/choose_samples.hpp"
#include "framework/study/pipeline/training/store_map.hpp"
#include "framework/study/pipeline/training/train_maps.hpp"
#include "framework/study/pipeline/trust/trust_power.hpp"
#include "framework/study/samples/ineffective_parameters.hpp"
#include "framework/study/samples/model_store.hpp"
#include "framework/study/samples/stencils.hpp"
#include "framework/study/samples/write_features.hpp"
#include "framework/tracking/track_power.hpp"

namespace twinmap {
namespace {

namespace fs = std::filesystem;

/// The run's own stores; none where its samples are shared.
struct OwnStores {
  std::unique_ptr<TrajectoryStore> samples, stencils;
};

OwnStores openOwnStores(const ExperimentSpec& experiment, const Simulator& simulator,
                        const RunOptions& options, const ResponseReduction* reduction) {
  if (options.samples != nullptr) {
    return {};
  }
  fs::path root = getStoreRoot(options.folder, options.store);
  if (reduction != nullptr) {  // what other directions make of the same responses lies elsewhere
    root /= fmt::format("reduced-{:016x}", reduction->calcDigest());
  }
  OwnStores stores{openStore(experiment.model, simulator.getLayout(), root), nullptr};
  if (!simulator.hasDerivatives() && listDerivativePoints(experiment).cols() > 0) {
    stores.stencils = openStencilStore(experiment.model, simulator.getLayout(), root);
  }
  return stores;
}

/// What is looked at of an experiment, by its simulator.
struct Looked {
  ExperimentSpec experiment;  ///< reduceExperiment() where samples are reduced
  std::unique_ptr<Simulator> simulator;
  std::shared_ptr<const ResponseReduction> reduction;  ///< null where they are not
};

Looked lookAt(const ExperimentSpec& experiment, const RunOptions& options, const RunControl& control) {
  if (options.samples != nullptr) {
    requireAllSamples(experiment, "a run that shares its samples with others");
  }
  std::unique_ptr<Simulator> whole =
      makeSimulator(experiment.model, collectTimes(experiment.features), countModes(experiment.features));
  logInfo("solver: " + whole->describeEngine());
  if (!isReduced(experiment)) {
    return {experiment, std::move(whole), nullptr};
  }
  auto reduction = std::make_shared<const ResponseReduction>(fitReduction(*whole, experiment, control));
  logInfo(reduction->describe(experiment.model.parameters));
  return {reduceExperiment(experiment, *reduction),
          std::make_unique<ReducedSimulator>(std::move(whole), reduction), reduction};
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

/// The simulated samples of a run, and those of them that failed.
struct Samples {
  SimulatedSets sets;
  std::vector<FailedSample> failures;
};

/// Simulates what is missing, writes samples.h5 and failures.csv, and throws where too many samples failed.
Samples simulateSamples(const Study& study) {
  const ExperimentSpec& experiment = study.experiment;
  SimulatedSets sets = simulateSets(study);
  writeSamplesFile(study.folder / "samples.h5", experiment.model, sets.train, sets.test);
  sets = failIncompleteSamples(experiment, study.extractor, std::move(sets));
  std::vector<FailedSample> failures = listFailures(sets);
  const fs::path file = study.folder / "failures.csv";
  writeTextFile(file, makeFailuresCsv(collectSampled(experiment.model), failures));
  requireFewFailures(experiment, failures, file);
  sets.notes.append(simulateStencils(experiment, *study.source, study.control));
  return {std::move(sets), std::move(failures)};
}

/// Writes trust_power.csv: what the trust model finds.
StageNotes writeTrustPower(const Study& study, const PreparedData& data, const OnlineModel& online) {
  StageNotes notes;
  throwIfCancelled(study.control);
  if (!online.trust || study.reduced != nullptr) {  // changed models have no reduced simulator
    return notes;
  }
  const auto changes = timeStage("what the goodness-of-fit test would find", notes,
                                 [&] { return calcTrustPower(study, data, online); });
  notes.warn(Severity::kInfo, listPowerWarnings(changes));
  writeTextFile(study.folder / "trust_power.csv", makeTrustPowerCsv(changes));
  return notes;
}

/// Writes responses.csv: the models of a few test samples beside what was measured.
StageNotes writeExamples(const Study& study, const PreparedData& data, const Evaluation& evaluation) {
  StageNotes notes;
  throwIfCancelled(study.control);
  const Trajectories& test = data.sets.test;
  const std::vector<ExampleResponse> examples = timeStage("simulate updated models", notes, [&] {
    return simulateExamples(study.experiment, study.simulator, test, data.test_indices, evaluation,
                            study.control.threads);
  });
  writeTextFile(
      study.folder / "responses.csv",
      makeResponsesCsv(examples, test.layout, calcNoiseStddev(study.experiment.noise, test.layout)));
  return notes;
}

/// How many training samples are taken, and what was found out about it.
SampleChoice chooseSamples(const Study& study, const RunOptions& options) {
  const SampleCount& asked = study.experiment.design.train.samples;
  const fs::path recorded = study.folder / "samples.h5";
  SampleChoice choice;
  if (study.experiment.inverse_map.isNone()) {
    return choice;
  }
  if (!asked.automatic || options.train_samples > 0) {
    choice.samples = asked.automatic ? options.train_samples : asked.number;
    return choice;
  }
  if (fs::exists(recorded)) {
    choice.samples = countTrainingSamples(recorded);
    return choice;
  }
  const int most = options.samples != nullptr ? asked.number  // a sweep has limited it
                                              : limitByTime(study.experiment, *study.simulator.clone());
  return chooseTrainingSamples(study, most);
}

/// The map of the choice where that was trained, else a new one.
TrainedMap trainOrTake(const Study& study, const PreparedData& data, SampleChoice& choice) {
  return choice.training ? makeTrainedMap(study, data, std::move(*choice.training))
                         : trainChosenMap(study, data);
}

/// What reducing the samples loses.
void noteReduction(const Study& study, StageNotes& notes) {
  if (study.reduced != nullptr) {
    notes.warn({Severity::kInfo, study.reduced->reduction->describe(study.experiment.model.parameters)});
  }
}

/// The stages of a run, one after the other.
RunSummary runStages(const Study& study, SampleChoice choice) {
  Samples samples = simulateSamples(study);
  RunSummary summary;
  summary.parameters = study.experiment.model.parameters;
  summary.failures = std::move(samples.failures);
  summary.reused_samples = samples.sets.reused - choice.simulated;
  summary.notes.append(choice.notes);
  noteReduction(study, summary.notes);
  summary.notes.append(samples.sets.notes);

  const PreparedData data =
      choice.data ? std::move(*choice.data) : prepareData(study, std::move(samples.sets));
  TrainedMap trained = trainOrTake(study, data, choice);
  MapEvaluation evaluated = evaluateMap(study, data, trained);
  ComparedMaps compared = compareMaps(study, data, evaluated.evaluation.limit_stddev);
  evaluated.evaluation.maps = std::move(compared.maps);
  evaluated.notes.append(compared.notes);
  storeMap(study.folder / "maps.h5", study, evaluated.evaluation, trained);
  evaluated.notes.append(writeTrustPower(study, data, trained.online));

  summary.test_indices = data.test_indices;
  summary.training = trained.summary;
  summary.notes.append(trained.notes);
  summary.notes.append(evaluated.notes);
  summary.notes.append(writeExamples(study, data, evaluated.evaluation));
  summary.evaluation = std::move(evaluated.evaluation);
  summary.online = timeStage("time the inference of one measurement", summary.notes,
                             [&] { return timeOnlineUpdates(trained.online, data.labelled.test); });
  return summary;
}

/// The stages of a run without a map.
RunSummary runStagesWithoutMap(const Study& study) {
  Samples samples = simulateSamples(study);
  RunSummary summary;
  summary.parameters = study.experiment.model.parameters;
  summary.training.nlml.assign(summary.parameters.size(), std::numeric_limits<double>::quiet_NaN());
  summary.failures = std::move(samples.failures);
  summary.reused_samples = samples.sets.reused;
  noteReduction(study, summary.notes);
  summary.notes.append(samples.sets.notes);

  PreparedData data = prepareData(study, std::move(samples.sets));
  PosteriorEvaluation found = evaluatePosteriors(study, data);
  summary.test_indices = data.test_indices;
  summary.notes.append(found.evaluated.notes);
  summary.notes.append(writeExamples(study, data, found.evaluated.evaluation));
  summary.evaluation = std::move(found.evaluated.evaluation);
  summary.online = found.times;
  return summary;
}

/// Writes the tables, then provenance.json, then the report from all of them; returns its gates.
std::vector<GateResult> writeFolder(const ExperimentSpec& experiment, const RunOptions& options, int threads,
                                    const RunSummary& run) {
  writeResults(options.folder, run);
  if (options.samples == nullptr &&
      run.evaluation.predictions.stddev.size() > 0) {  // not each case of a sweep
    writeTextFile(options.folder / "track_power.csv",
                  makeTrackPowerCsv(run.parameters, run.evaluation.predictions, experiment.seed));
  }
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

RunSummary runExperiment(const ExperimentSpec& given, const RunOptions& options, const RunControl& control) {
  requireStatedNoise(given);
  makeFolders(options.folder);
  const FolderLock lock(options.folder);
  const std::unique_ptr<RunLog> log = options.samples ? nullptr : std::make_unique<RunLog>(options.folder);
  const ExperimentSpec experiment = options.samples ? given : followNoise(given);  // a sweep has done so
  beginFolder(experiment, options);

  Looked looked = lookAt(experiment, options, control);
  const Simulator& simulator = *looked.simulator;
  if (options.samples == nullptr) {
    warnOfIneffective(experiment.model, simulator);
    logFiniteDifferenceSteps(experiment, *looked.simulator);
  }
  const ExperimentSpec& seen = looked.experiment;
  const FeatureExtractor extractor = makeExtractor(seen, simulator.getLayout());
  checkTransformOf(extractor.getInfos(), seen.transform);
  const OwnStores stores = openOwnStores(seen, simulator, options, looked.reduction.get());
  const SampleSource source =
      options.samples ? *options.samples : SampleSource{simulator, *stores.samples, stores.stencils.get()};

  const FeatureNoise noise(extractor, ResponseNoise(seen.noise, simulator.getLayout()), seen.seed);
  const ReducedStudy reduced{experiment, looked.reduction};
  const Study asked{seen,    simulator,      extractor, noise,
                    &source, options.folder, control,   looked.reduction ? &reduced : nullptr};
  SampleChoice choice = chooseSamples(asked, options);
  const bool has_map = !seen.inverse_map.isNone();
  const ExperimentSpec chosen =
      has_map && seen.design.train.samples.automatic ? takeTrainingSamples(seen, choice.samples) : seen;
  RunSummary run = has_map ? runStages(asked.with(chosen), std::move(choice)) : runStagesWithoutMap(asked);
  throwIfCancelled(control);
  run.gates = writeFolder(experiment, options, control.threads, run);
  return run;
}

void runFeatures(const ExperimentSpec& experiment, const RunOptions& options, const RunControl& control) {
  requireAllSamples(experiment, "--features-only");
  if (experiment.design.train.samples.automatic) {
    throw ExperimentError(
        "--features-only needs a number of training samples, which is chosen by training: set "
        "design.train.samples");
  }
  makeFolders(options.folder);
  const FolderLock lock(options.folder);
  const RunLog log(options.folder);
  const std::unique_ptr<Simulator> simulator =
      makeSimulator(experiment.model, collectTimes(experiment.features), countModes(experiment.features));
  logInfo(fmt::format("solver: {}", simulator->describeEngine()));
  warnOfIneffective(experiment.model, *simulator);
  const FeatureExtractor extractor = makeExtractor(experiment, simulator->getLayout());
  noteStore(options.folder, options.store);
  const std::unique_ptr<TrajectoryStore> store =
      openStore(experiment.model, simulator->getLayout(), getStoreRoot(options.folder, options.store));
  writeFeatures(options.folder / "features.h5", experiment, extractor, {*simulator, *store, nullptr},
                control);
}

}  // namespace twinmap
