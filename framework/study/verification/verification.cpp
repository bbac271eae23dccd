#include "framework/study/verification/verification.hpp"

#include <algorithm>
#include <limits>

#include "framework/analysis/information_limit.hpp"
#include "framework/base/files/atomic_file.hpp"
#include "framework/base/files/temporary_folder.hpp"
#include "framework/base/hdf5/sealed_file.hpp"
#include "framework/base/random/slices.hpp"
#include "framework/data/features/experiment_features.hpp"
#include "framework/data/sensitivity/fisher_information.hpp"
#include "framework/estimation/gp/online_processes.hpp"
#include "framework/estimation/gp/train_gp_map.hpp"
#include "framework/experiment/check/known_names.hpp"
#include "framework/experiment/files/experiment_file.hpp"
#include "framework/experiment/files/resolve_defaults.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/models/make_simulator.hpp"
#include "framework/results/tables.hpp"
#include "framework/store/finished_run.hpp"
#include "framework/store/hdf5_difference.hpp"
#include "framework/store/predictions_file.hpp"
#include "framework/store/provenance.hpp"
#include "framework/store/samples_file.hpp"
#include "framework/store/trained_file.hpp"
#include "framework/study/pipeline/evaluate_estimates.hpp"
#include "framework/study/pipeline/preparation/prepare_data.hpp"
#include "framework/study/pipeline/preparation/simulated_sets.hpp"
#include "framework/study/pipeline/run_experiment.hpp"
#include "framework/study/pipeline/select_answers.hpp"
#include "framework/study/pipeline/training/store_map.hpp"
#include "framework/study/pipeline/training/train_maps.hpp"
#include "framework/study/verification/file_difference.hpp"
#include "framework/study/verification/sample_checks.hpp"

namespace twinmap {
namespace {

namespace fs = std::filesystem;

using Eigen::Index;
using Eigen::MatrixXd;

/// p x n of the parameters, q x n of the derived quantities.
struct Limits {
  MatrixXd parameters, derived;
};

/// The column limit_stddev of a file, r x n; NaN where it has another shape.
MatrixXd readLimit(const std::filesystem::path& file, const std::vector<std::string>& names, Index samples) {
  const auto rows = static_cast<Index>(names.size());
  MatrixXd limit = rows > 0 ? readPredictionsFile(file, names).limit_stddev : MatrixXd();
  if (limit.rows() != rows || limit.cols() != samples) {
    limit.setConstant(rows, samples, std::numeric_limits<double>::quiet_NaN());
  }
  return limit;
}

/// The limit of all test samples as the files of a folder have it, and of `chosen` ones computed again.
Limits calcLimits(const Study& study, const PreparedData& data, const std::vector<int>& chosen,
                  const std::filesystem::path& folder) {
  if (!hasInformationLimit(study.experiment, data.labelled.test)) {
    return {};
  }
  const std::vector<ParameterSpec>& parameters = study.experiment.model.parameters;
  const MatrixXd& truth = data.labelled.test.parameters;
  Limits limits{readLimit(folder / "predictions.csv", collectNames(parameters), truth.cols()),
                readLimit(folder / "derived.csv", collectNames(study.experiment.derived), truth.cols())};
  std::vector<Index> columns;
  for (const int sample : chosen) {
    const auto found = std::find(data.test_indices.begin(), data.test_indices.end(), sample);
    if (found != data.test_indices.end()) {
      columns.push_back(found - data.test_indices.begin());
    }
  }
  if (!columns.empty()) {
    const MatrixXd points = data.labelled.test.collectPoints()(Eigen::all, columns);
    const Prior prior(collectUnknown(study.experiment.model), study.experiment.model.priors);
    const MatrixXd unknown =
        points.topRows(static_cast<Index>(collectUnknown(study.experiment.model).size()));
    const InformationLimit limit = calcInformationLimit(calcLocalModels(study, points), study.noise,
                                                        parameters, prior.calcInformation(unknown));
    limits.parameters(Eigen::all, columns) = limit.stddev;
    limits.derived(Eigen::all, columns) = calcDerivedLimit(DerivedQuantities(study.experiment), parameters,
                                                           points.topRows(truth.rows()), limit);
  }
  return limits;
}

/// Processes are fitted at the hyperparameters of the file, without a search; a surrogate is trained again.
TrainedMap trainAgain(const Study& study, const PreparedData& data, const TrainedFile& stored) {
  const auto* processes = dynamic_cast<const OnlineProcesses*>(stored.model.map.get());
  if (processes == nullptr) {
    return trainChosenMap(study, data);
  }
  const ExperimentSpec& experiment = study.experiment;
  const LabelledFeatures& train = data.labelled.train;
  GpMapTraining fitted =
      refitGpMap(processes->getMap(), *experiment.inverse_map.findProcesses(), experiment.transform, train,
                 study.control.threads, experiment.model.inputs);
  return makeTrainedMap(study, data, makeTraining(experiment, train, std::move(fitted)));
}

RunSummary summarize(const Study& study, const PreparedData& data, const TrainedMap& map,
                     const InferredTests& tests, const Limits& limits) {
  const LabelledFeatures& test = data.labelled.test;
  RunSummary run;
  run.parameters = study.experiment.model.parameters;
  run.test_indices = data.test_indices;
  const Estimates estimates = selectAnswers(tests, map.residual_correlation, test.parameters);
  run.evaluation = evaluateEstimates(run.parameters, test.parameters, estimates, limits.parameters);
  const DerivedQuantities quantities(study.experiment);
  if (quantities.count() > 0) {
    run.evaluation.derived = evaluateDerived(quantities, test.parameters, estimates, limits.derived);
  }
  run.evaluation.refined = tests.refined;
  run.evaluation.answers = summarizeAnswers(tests);
  run.training = map.summary;
  return run;
}

struct TextFile {
  const char* name;
  std::string (*make)(const RunSummary& run);
};

constexpr TextFile kTables[] = {{"metrics.csv", makeMetricsCsv},
                                {"joint.csv", makeJointCsv},
                                {"pit.csv", makePitCsv},
                                {"table.md", makeMarkdownTable},
                                {"table.tex", makeLatexTable}};

std::string findDifference(const std::filesystem::path& file, const std::string& expected) {
  const std::string text = readBytes(file);
  return file.extension() == ".csv" ? findCsvDifference(text, expected) : findTextDifference(text, expected);
}

void checkMapAndTables(const Study& study, const PreparedData& data, const std::vector<int>& limits,
                       Verification& verification) {
  const std::filesystem::path& folder = verification.folder;
  std::optional<TrainedMap> map;
  InferredTests tests;
  verification.check("maps.h5: fitted again", [&] {
    const TrainedFile stored = readTrainedFile(folder / "maps.h5", Hdf5Seal::kNone);  // differences: below
    map = trainAgain(study, data, stored);
    if (map->online.trust && stored.model.trust) {
      map->online.trust->posteriors =
          stored.model.trust->posteriors;  // the calibration's, which is not fitted
    }
    tests = inferTestSamples(study, data, *map);
    const TemporaryFolder temporary;
    storeMap(temporary.getPath() / "maps.h5", study, {}, *map);
    std::string difference = findHdf5Difference(folder / "maps.h5", temporary.getPath() / "maps.h5");
    if (difference.empty()) {
      readSealedFile(folder / "maps.h5");  // or throws
    }
    return difference;
  });
  if (!map) {
    verification.notes.emplace_back("predictions and tables are not compared, for they follow from maps.h5");
    return;
  }
  RunSummary run;
  verification.check("predictions.csv: all test samples inferred again", [&] {
    run = summarize(study, data, *map, tests, calcLimits(study, data, limits, folder));
    return findDifference(folder / "predictions.csv", makePredictionsCsv(run));
  });
  if (run.evaluation.derived) {
    verification.check("derived.csv: made again",
                       [&] { return findDifference(folder / "derived.csv", makeDerivedCsv(run)); });
  }
  if (run.evaluation.metrics.empty()) {
    verification.notes.emplace_back("tables are not compared, for they follow from predictions.csv");
    return;
  }
  for (const TextFile& table : kTables) {
    verification.check(std::string(table.name) + ": made again",
                       [&] { return findDifference(folder / table.name, table.make(run)); });
  }
}

/// Checks maps.h5, predictions.csv and the tables (see verifyRun) against what follows from `sets`. `limits`:
/// the test samples whose information limit is computed again.
void checkResults(const ExperimentSpec& experiment, const Simulator& simulator, SimulatedSets sets,
                  const std::vector<int>& limits, int threads, Verification& verification) {
  const FeatureExtractor extractor = makeExtractor(experiment, simulator.getLayout());
  sets = failIncompleteSamples(experiment, extractor, std::move(sets));
  const FeatureNoise noise(extractor, ResponseNoise(experiment.noise, sets.train.layout), experiment.seed);
  RunControl control;
  control.threads = threads;
  const Study study{experiment, simulator, extractor, noise, nullptr, verification.folder, control};
  checkMapAndTables(study, prepareData(study, std::move(sets)), limits, verification);
}

void verifyPart(const ExperimentSpec& experiment, const VerifyOptions& options, Verification& verification) {
  requireAllSamples(experiment, "a verification of some samples ('twinmap verify' without --all)");
  const std::unique_ptr<Simulator> made =
      makeSimulator(experiment.model, collectTimes(experiment.features), countModes(experiment.features));
  const Simulator& simulator = *made;
  const ChosenSamples chosen{chooseSome(options.samples, experiment.design.train.samples, options.seed, 0),
                             chooseSome(options.samples, experiment.design.test.samples, options.seed, 1)};
  try {
    const SimulatedSets sets = checkSamples(experiment, simulator, chosen, options.threads, verification);
    checkResults(experiment, simulator, sets, chosen.test, options.threads, verification);
  } catch (const UnreadableSamples& error) {
    verification.checks.push_back({"samples.h5: can be read", error.what()});
    verification.notes.emplace_back("the other files are not compared, for they follow from samples.h5");
  }
}

/// With the number of training samples that the run took, where that is automatic.
ExperimentSpec takeRecordedSamples(const ExperimentSpec& experiment, const fs::path& folder) {
  return experiment.design.train.samples.automatic
             ? takeTrainingSamples(experiment, countTrainingSamples(folder / "samples.h5"))
             : experiment;
}

/// All files of a run that follow from its experiment alone.
std::vector<fs::path> listResults(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
    const fs::path file = entry.path().lexically_relative(folder);
    const bool of_one_run = file == "provenance.json" || file == "report.html" || file == "lock" ||
                            file.extension() == ".log" || *file.begin() == "chunks" ||
                            *file.begin() == "figures";
    if (entry.is_regular_file() && !of_one_run) {
      files.push_back(file);
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

void verifyAll(const ExperimentSpec& experiment, const VerifyOptions& options, Verification& verification) {
  const TemporaryFolder temporary;
  RunOptions run;
  run.folder = temporary.getPath();
  run.train_samples = countTrainingSamples(verification.folder / "samples.h5");
  RunControl control;
  control.threads = options.threads;
  runExperiment(experiment, run, control);
  for (const fs::path& file : listResults(run.folder)) {
    verification.check(file.string(),
                       [&] { return findFileDifference(verification.folder / file, run.folder / file); });
  }
}

}  // namespace

std::vector<int> chooseSome(int count, int total, std::uint64_t seed, int stream) {
  std::vector<int> chosen = makePermutation(total, {seed, RandomPurpose::kVerification}, stream);
  chosen.resize(std::min(count, total));
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

Verification verifyRun(const fs::path& folder, const VerifyOptions& options) {
  requireFinishedRun(folder, {"samples.h5", "predictions.csv", "metrics.csv"});
  Verification verification;
  verification.folder = folder;
  const std::string provenance = readBytes(folder / "provenance.json");
  verification.build_differences = listBuildDifferences(provenance);
  verification.check("files: digests in provenance.json",
                     [&] { return findChangedFile(provenance, folder); });
  const ExperimentSpec experiment = loadExperiment((folder / "resolved.yaml").string());
  if (!experiment.inverse_map.isNone()) {
    requireFinishedRun(folder, {"maps.h5"});
  }
  if (options.all || experiment.inverse_map.isNone()) {  // posteriors take as long as the run
    verifyAll(experiment, options, verification);
  } else {
    verifyPart(takeRecordedSamples(experiment, folder), options, verification);
  }
  return verification;
}

}  // namespace twinmap
