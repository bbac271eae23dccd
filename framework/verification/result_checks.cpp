#include "framework/verification/result_checks.hpp"

#include <algorithm>
#include <limits>

#include "framework/evaluation/information_limit.hpp"
#include "framework/experiment/answers.hpp"
#include "framework/experiment/fit_online.hpp"
#include "framework/experiment/prepare_data.hpp"
#include "framework/experiment/refine_test_samples.hpp"
#include "framework/inverse_map/train_gp_map.hpp"
#include "framework/results/tables.hpp"
#include "framework/sensitivity/fisher_information.hpp"
#include "framework/spec/check/check_experiment.hpp"
#include "framework/spec/parameter_box.hpp"
#include "framework/store/atomic_file.hpp"
#include "framework/store/hdf5_difference.hpp"
#include "framework/store/maps_file.hpp"
#include "framework/store/predictions_file.hpp"
#include "framework/store/temporary_folder.hpp"
#include "framework/verification/file_difference.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

/// What the results of a run follow from.
struct Inputs {
  const ExperimentSpec& experiment;
  const Simulator& simulator;
  const FeatureExtractor& extractor;
  const SimulatedSets& sets;
  const PreparedData& data;
  int threads;
};

std::string findMapDifference(const std::filesystem::path& file, const Inputs& inputs, const GpMap& map,
                              const OnlineModel& online) {
  const TemporaryFolder temporary;
  writeMapsFile(temporary.getPath() / "maps.h5",
                makeStoredMap(inputs.experiment, inputs.extractor, map, online));
  return findHdf5Difference(file, temporary.getPath() / "maps.h5");
}

/// The limit of all test samples as the file has it, and of `chosen` ones computed again.
MatrixXd calcLimit(const Inputs& inputs, const std::vector<int>& chosen,
                   const std::filesystem::path& predictions) {
  if (!hasInformationLimit(inputs.experiment, inputs.data.labelled.test)) {
    return {};
  }
  const std::vector<ParameterSpec>& parameters = inputs.experiment.model.parameters;
  const MatrixXd& truth = inputs.data.labelled.test.parameters;
  MatrixXd limit = readPredictionsFile(predictions, collectNames(parameters)).limit_stddev;
  if (limit.rows() != truth.rows() || limit.cols() != truth.cols()) {
    limit.setConstant(truth.rows(), truth.cols(), std::numeric_limits<double>::quiet_NaN());
  }
  std::vector<Index> columns;
  for (const int sample : chosen) {
    const auto found = std::find(inputs.data.test_indices.begin(), inputs.data.test_indices.end(), sample);
    if (found != inputs.data.test_indices.end()) {
      columns.push_back(found - inputs.data.test_indices.begin());
    }
  }
  if (!columns.empty()) {
    const MatrixXd points = inputs.data.labelled.test.collectPoints()(Eigen::all, columns);
    const auto models = calcLocalModels(inputs.simulator, inputs.extractor,
                                        collectUnknown(inputs.experiment.model), points, inputs.threads);
    limit(Eigen::all, columns) = calcInformationLimit(models, inputs.data.noise, parameters).stddev;
  }
  return limit;
}

RunSummary summarize(const Inputs& inputs, const GpMapTraining& trained, const OnlineModel& online,
                     const MatrixXd& limit) {
  const LabelledSets& labelled = inputs.data.labelled;
  const Predictions predictions = trained.map.predict(labelled.test.features, labelled.test.inputs);
  RunControl control;
  control.threads = inputs.threads;
  const RefinedTests refined = refineTestSamples(
      {inputs.experiment, inputs.simulator, inputs.extractor, inputs.data, &online, predictions, control});
  RunSummary run;
  run.parameters = inputs.experiment.model.parameters;
  run.test_indices = inputs.data.test_indices;
  run.evaluation =
      evaluateAnswers(run.parameters, labelled.test.parameters,
                      makeAnswers(predictions, trained.map.residual_correlation, refined.refined), limit);
  run.evaluation.refined = refined.refined;
  run.training.leave_one_out = calcMetrics(run.parameters, labelled.train.parameters, trained.leave_one_out,
                                           {}, labelled.train.replicates);
  for (const gp::Process& process : trained.map.processes) {
    run.training.nlml.push_back(gp::getNlml(process));
  }
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

void checkMapAndTables(const Inputs& inputs, const std::vector<int>& limits, Verification& verification) {
  const std::filesystem::path& folder = verification.folder;
  if (inputs.experiment.inverse_map.findGp() == nullptr) {
    verification.notes.emplace_back(
        "a surrogate is not kept: predictions and tables are compared by --all alone, which trains it again");
    return;
  }
  GpMapTraining trained;
  OnlineModel online;
  verification.check("maps.h5: refitted at its hyperparameters", [&] {
    trained = refitGpMap(readMapsFile(folder / "maps.h5").map, *inputs.experiment.inverse_map.findGp(),
                         inputs.experiment.transform, inputs.data.labelled.train, inputs.threads,
                         inputs.experiment.model.inputs);
    online = fitOnline({inputs.experiment,
                        inputs.sets,
                        inputs.extractor,
                        inputs.data.labelled,
                        {inputs.threads, nullptr}},
                       trained.map)
                 .model;
    return findMapDifference(folder / "maps.h5", inputs, trained.map, online);
  });
  if (trained.map.processes.empty()) {
    verification.notes.emplace_back("predictions and tables are not compared, for they follow from maps.h5");
    return;
  }
  RunSummary run;
  verification.check("predictions.csv: all test samples inferred again", [&] {
    run = summarize(inputs, trained, online, calcLimit(inputs, limits, folder / "predictions.csv"));
    return findDifference(folder / "predictions.csv", makePredictionsCsv(run));
  });
  if (run.evaluation.metrics.empty()) {
    verification.notes.emplace_back("tables are not compared, for they follow from predictions.csv");
    return;
  }
  for (const TextFile& table : kTables) {
    verification.check(std::string(table.name) + ": made again",
                       [&] { return findDifference(folder / table.name, table.make(run)); });
  }
}

}  // namespace

void checkResults(const ExperimentSpec& experiment, const Simulator& simulator, SimulatedSets sets,
                  const std::vector<int>& limits, int threads, Verification& verification) {
  const FeatureExtractor extractor = makeExtractor(experiment, simulator.getLayout());
  sets = failIncompleteSamples(experiment, extractor, std::move(sets));
  const LocalModelSource local_models = [&](const MatrixXd& points) {
    return calcLocalModels(simulator, extractor, collectUnknown(experiment.model), points, threads);
  };
  const PreparedData data = prepareData(experiment, extractor, sets, local_models);
  checkMapAndTables({experiment, simulator, extractor, sets, data, threads}, limits, verification);
}

}  // namespace twinmap
