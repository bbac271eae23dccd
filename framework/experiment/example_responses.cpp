#include "framework/experiment/example_responses.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "framework/features/noise.hpp"
#include "framework/monitoring/stage_timer.hpp"
#include "framework/results/responses_csv.hpp"
#include "framework/spec/parameter_box.hpp"
#include "framework/store/atomic_file.hpp"

namespace twinmap {
namespace {

/// Columns of the predictions in the order of their error.
std::vector<Eigen::Index> sortByError(const RunSummary& run) {
  const Eigen::ArrayXXd error = (run.predictions.mean - run.truth).array();
  const Eigen::ArrayXd mean_square = error.square().rowwise().mean();
  const Eigen::ArrayXd normalised = (error.square().colwise() / mean_square).colwise().sum().transpose();
  std::vector<Eigen::Index> order(static_cast<std::size_t>(normalised.size()));
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](Eigen::Index a, Eigen::Index b) { return normalised[a] < normalised[b]; });
  return order;
}

/// Of each sample the nominal, then the updated parameters; nuisance and inputs are the sample's own.
Eigen::MatrixXd makeExamplePoints(const ExperimentSpec& experiment, const Trajectories& test,
                                  const std::vector<Eigen::Index>& shown, const RunSummary& run) {
  const Eigen::Index p = run.truth.rows();
  Eigen::MatrixXd points(test.parameters.rows(), 2 * shown.size());
  for (std::size_t i = 0; i < shown.size(); ++i) {
    auto both = points.middleCols(static_cast<Eigen::Index>(2 * i), 2);
    both.colwise() = test.parameters.col(run.test_indices[static_cast<std::size_t>(shown[i])]);
    both.topRows(p) << calcBoxCenter(experiment.model.parameters), run.predictions.mean.col(shown[i]);
  }
  return points;
}

}  // namespace

void writeExampleResponses(const ExperimentSpec& experiment, const SimulatedSets& sets,
                           const Simulator& simulator, const RunOptions& options, RunSummary& run) {
  const std::vector<Eigen::Index> order = sortByError(run);
  const std::vector<Eigen::Index> shown{order.front(), order[order.size() / 2], order.back()};
  const Eigen::MatrixXd points = makeExamplePoints(experiment, sets.test, shown, run);
  GeneratorOptions generator;
  generator.threads = options.threads;
  const Trajectories models = timeStage("simulate updated models", run.times,
                                        [&] { return generateSamples(simulator, points, generator); });

  const ResponseNoise noise(experiment.noise, sets.test.layout);
  const Eigen::MatrixXd measured =
      addNoise(sets.test.responses, noise, {experiment.seed, RandomPurpose::kTestNoise});
  const std::vector<std::string> names{"best", "median", "worst"};
  std::vector<ExampleResponse> examples;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const int sample = run.test_indices[static_cast<std::size_t>(shown[i])];
    examples.push_back({names[i], sample, measured.col(sample),
                        models.responses.col(static_cast<Eigen::Index>(2 * i)),
                        models.responses.col(static_cast<Eigen::Index>(2 * i + 1))});
  }
  writeTextFile(options.folder / "responses.csv",
                makeResponsesCsv(examples, sets.test.layout, noise.getStddev()));
}

}  // namespace twinmap
