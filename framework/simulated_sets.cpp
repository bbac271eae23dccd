#include "framework/simulated_sets.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "framework/design/point_set.hpp"
#include "framework/report/tables.hpp"
#include "framework/stage_timer.hpp"
#include "framework/store/atomic_file.hpp"
#include "framework/store/samples_file.hpp"

namespace twinmap {
namespace {

namespace fs = std::filesystem;

std::vector<FailedSample> collectFailures(const std::string& set, const Trajectories& trajectories) {
  std::vector<FailedSample> failures;
  for (std::size_t i = 0; i < trajectories.statuses.size(); ++i) {
    if (!trajectories.statuses[i].ok) {
      failures.push_back({set, static_cast<int>(i), trajectories.parameters.col(static_cast<Eigen::Index>(i)),
                          trajectories.statuses[i].reason});
    }
  }
  return failures;
}

void requireFewFailures(const std::vector<FailedSample>& failures, const std::string& set, int samples,
                        double allowed_fraction, const fs::path& folder) {
  int failed = 0;
  const FailedSample* first = nullptr;
  for (const FailedSample& failure : failures) {
    if (failure.set == set) {
      first = first == nullptr ? &failure : first;
      ++failed;
    }
  }
  if (failed > allowed_fraction * samples || samples - failed < 2) {
    throw std::runtime_error(fmt::format(
        "{} of {} {} samples could not be simulated, more than simulation.allowed_failures = {} permits; the "
        "first is sample {}: {}; all are listed in {}",
        failed, samples, set, allowed_fraction, first->sample, first->reason,
        (folder / "failures.csv").string()));
  }
}

}  // namespace

std::vector<int> findSuccessful(const Trajectories& trajectories) {
  std::vector<int> samples;
  for (std::size_t i = 0; i < trajectories.statuses.size(); ++i) {
    if (trajectories.statuses[i].ok) {
      samples.push_back(static_cast<int>(i));
    }
  }
  return samples;
}

SimulatedSets simulateSets(const ExperimentSpec& experiment, const Simulator& simulator,
                           const RunOptions& options, RunSummary& run) {
  const ModelSpec& model = experiment.model;
  GeneratorOptions generator;
  generator.threads = options.threads;
  const auto simulate = [&](const std::string& set, const PointSetSpec& design, RandomPurpose purpose) {
    const Eigen::MatrixXd points = samplePoints(design, model.parameters, experiment.seed, purpose);
    Trajectories trajectories =
        timeStage(fmt::format("simulate {} {} samples", points.cols(), set), run.times,
                  [&] { return generateSamples(simulator, points, generator); });
    const std::vector<FailedSample> failures = collectFailures(set, trajectories);
    run.failures.insert(run.failures.end(), failures.begin(), failures.end());
    return trajectories;
  };
  const SimulatedSets sets{simulate("train", experiment.design.train, RandomPurpose::kTrainDesign),
                           simulate("test", experiment.design.test, RandomPurpose::kTestDesign)};
  writeSamplesFile(options.folder / "samples.h5", model, sets.train, sets.test);
  writeTextFile(options.folder / "failures.csv", makeFailuresCsv(run));
  for (const auto& [set, samples] : {std::pair("train", run.train_samples), {"test", run.test_samples}}) {
    requireFewFailures(run.failures, set, samples, model.simulation.allowed_failures, options.folder);
  }
  return sets;
}

}  // namespace twinmap
