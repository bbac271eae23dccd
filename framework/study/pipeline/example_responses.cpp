#include "framework/study/pipeline/example_responses.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "framework/base/text/escape.hpp"
#include "framework/base/text/number_text.hpp"
#include "framework/data/noise/noise.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "kernels/linalg/order.hpp"

namespace twinmap {
namespace {

/// Columns of the predictions in the order of their error.
std::vector<Eigen::Index> sortByError(const Evaluation& evaluation) {
  const Eigen::ArrayXXd error =
      (evaluation.predictions.mean.leftCols(evaluation.truth.cols()) - evaluation.truth).array();
  const Eigen::ArrayXd mean_square = error.square().rowwise().mean();
  const Eigen::ArrayXd normalised = (error.square().colwise() / mean_square).colwise().sum().transpose();
  return sortIndices(normalised.size(),
                     [&](Eigen::Index a, Eigen::Index b) { return normalised[a] < normalised[b]; });
}

/// Of each sample the nominal, then the updated parameters; nuisance and inputs are the sample's own.
Eigen::MatrixXd makeExamplePoints(const ExperimentSpec& experiment, const Trajectories& test,
                                  const std::vector<int>& test_indices,
                                  const std::vector<Eigen::Index>& shown, const Evaluation& evaluation) {
  const Eigen::Index p = evaluation.truth.rows();
  Eigen::MatrixXd points(test.parameters.rows(), 2 * shown.size());
  for (std::size_t i = 0; i < shown.size(); ++i) {
    auto both = points.middleCols(static_cast<Eigen::Index>(2 * i), 2);
    both.colwise() = test.parameters.col(test_indices[static_cast<std::size_t>(shown[i])]);
    both.topRows(p) << calcBoxCenter(experiment.model.parameters), evaluation.predictions.mean.col(shown[i]);
  }
  return points;
}

/// Trials end at different times: there is no measurement after the end of a shorter one.
void endTrials(const ModelSpec& model, const ResponseLayout& layout, Eigen::VectorXd& measured) {
  Eigen::Index output = 0;
  for (const TrialModel& trial : model.trials) {
    for (std::size_t o = 0; o < trial.model.outputs.size(); ++o, ++output) {
      auto rows = measured.segment(layout.getRow(output, 0), layout.times.size()).array();
      rows = (layout.times.array() > trial.model.simulation.duration)
                 .select(std::numeric_limits<double>::quiet_NaN(), rows);
    }
  }
}

}  // namespace

std::vector<ExampleResponse> simulateExamples(const ExperimentSpec& experiment, const Simulator& simulator,
                                              const Trajectories& test, const std::vector<int>& test_indices,
                                              const Evaluation& evaluation, int threads) {
  const std::vector<Eigen::Index> order = sortByError(evaluation);
  const std::vector<Eigen::Index> shown{order.front(), order[order.size() / 2], order.back()};
  const Eigen::MatrixXd points = makeExamplePoints(experiment, test, test_indices, shown, evaluation);
  GeneratorOptions generator;
  generator.threads = threads;
  const Trajectories models = generateSamples(simulator, points, generator);

  const Eigen::MatrixXd measured = addNoise(test.responses, ResponseNoise(experiment.noise, test.layout),
                                            {experiment.seed, RandomPurpose::kTestNoise});
  const std::vector<std::string> names{"best", "median", "worst"};
  std::vector<ExampleResponse> examples;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const int sample = test_indices[static_cast<std::size_t>(shown[i])];
    examples.push_back({names[i], sample, measured.col(sample),
                        models.responses.col(static_cast<Eigen::Index>(2 * i)),
                        models.responses.col(static_cast<Eigen::Index>(2 * i + 1))});
    endTrials(experiment.model, test.layout, examples.back().measured);
  }
  return examples;
}

namespace {

std::string makeCell(double value) {
  return "," + (std::isfinite(value) ? toText(value) : "");
}

}  // namespace

std::string makeResponsesCsv(const std::vector<ExampleResponse>& examples, const ResponseLayout& layout,
                             const Eigen::VectorXd& row_stddev) {
  std::string csv = "case,sample,output,unit,time,measured,nominal,updated,noise_stddev\n";
  for (const ExampleResponse& example : examples) {
    for (Eigen::Index output = 0; output < layout.getOutputCount(); ++output) {
      const auto o = static_cast<std::size_t>(output);
      const std::string start =
          fmt::format("{},{},{},{}", example.name, example.sample, escapeCsv(layout.output_names[o]),
                      escapeCsv(layout.output_units[o]));
      for (Eigen::Index time = 0; time < layout.times.size(); ++time) {
        const Eigen::Index row = layout.getRow(output, time);
        if (std::isnan(example.measured[row])) {
          continue;
        }
        csv += start + makeCell(layout.times[time]) + makeCell(example.measured[row]) +
               makeCell(example.nominal[row]) + makeCell(example.updated[row]) + makeCell(row_stddev[row]) +
               "\n";
      }
    }
  }
  return csv;
}

}  // namespace twinmap
