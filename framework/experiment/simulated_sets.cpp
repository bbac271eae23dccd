#include "framework/experiment/simulated_sets.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <stdexcept>

#include "framework/design/point_set.hpp"
#include "framework/monitoring/interrupted.hpp"
#include "framework/monitoring/stage_timer.hpp"
#include "framework/results/tables.hpp"
#include "framework/sampling/store_content.hpp"
#include "framework/spec/parameter_box.hpp"
#include "framework/store/atomic_file.hpp"
#include "framework/store/samples_file.hpp"

namespace twinmap {
namespace {

namespace fs = std::filesystem;

void appendFailures(const std::string& set, const Trajectories& trajectories,
                    std::vector<FailedSample>& failures) {
  for (std::size_t i = 0; i < trajectories.statuses.size(); ++i) {
    if (!trajectories.statuses[i].ok) {
      failures.push_back({set, static_cast<int>(i), trajectories.parameters.col(static_cast<Eigen::Index>(i)),
                          trajectories.statuses[i].reason});
    }
  }
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
    throw std::runtime_error(
        fmt::format("{} of {} {} samples failed, more than simulation.allowed_failures = {} permits; the "
                    "first is sample {}: "
                    "{}; all are listed in {}",
                    failed, samples, set, allowed_fraction, first->sample, first->reason,
                    (folder / "failures.csv").string()));
  }
}

void noteReused(int reused, const std::string& set, RunSummary& run) {
  run.reused_samples += reused;
  if (reused > 0) {
    spdlog::info("{} of the {} samples had been simulated before", reused, set);
  }
}

Trajectories simulateSet(const std::string& set, const Eigen::MatrixXd& points, const SampleSource& source,
                         const RunOptions& options, RunSummary& run) {
  StoredTrajectories stored =
      timeStage(fmt::format("simulate {} {} samples", points.cols(), set), run.times, [&] {
        return simulateMissing(source.store, source.simulator, points,
                               makeMissingOptions("simulate " + set, 1, options));
      });
  if (stored.stopped) {
    throw Interrupted(fmt::format("interrupted: {} of {} {} samples are simulated and kept",
                                  stored.counts.reused + stored.counts.simulated, points.cols(), set));
  }
  noteReused(stored.counts.reused, set, run);
  return std::move(stored.trajectories);
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

MissingOptions makeMissingOptions(const std::string& stage, int simulations, const RunOptions& options) {
  MissingOptions missing;
  missing.threads = options.threads;
  missing.stop = options.stop;
  if (options.progress) {
    missing.progress = [=, &options](const SimulationProgress& counts) {
      options.progress({stage, simulations * counts.simulated, simulations * counts.total,
                        simulations * counts.failed, double(counts.simulated) / counts.total, true});
    };
  }
  return missing;
}

void logSetAside(const TrajectoryStore& store) {
  for (const SetAsideChunk& chunk : store.getSetAside()) {
    spdlog::warn("{}: set aside: {}; its samples are simulated again", chunk.file.string(), chunk.reason);
  }
}

std::unique_ptr<TrajectoryStore> openStore(const ModelSpec& model, const ResponseLayout& layout,
                                           const fs::path& root) {
  auto store = std::make_unique<TrajectoryStore>(root, writeStoreContent(model, layout), countSampled(model),
                                                 layout.getRowCount());
  logSetAside(*store);
  return store;
}

SimulatedSets simulateSets(const ExperimentSpec& experiment, const SampleSource& source,
                           const ResponseLayout& layout, const RunOptions& options, RunSummary& run) {
  const std::vector<ParameterSpec> sampled = collectSampled(experiment.model);
  const auto simulate = [&](const std::string& set, const PointSetSpec& design, RandomPurpose purpose) {
    const Eigen::MatrixXd points = samplePoints(design, sampled, experiment.seed, purpose);
    return selectRows(simulateSet(set, points, source, options, run), layout);
  };
  SimulatedSets sets{simulate("train", experiment.design.train, RandomPurpose::kTrainDesign),
                     simulate("test", experiment.design.test, RandomPurpose::kTestDesign)};
  writeSamplesFile(options.folder / "samples.h5", experiment.model, sets.train, sets.test);
  return sets;
}

void recordFailures(const ExperimentSpec& experiment, const SimulatedSets& sets, const RunOptions& options,
                    RunSummary& run) {
  run.failures.clear();
  appendFailures("train", sets.train, run.failures);
  appendFailures("test", sets.test, run.failures);
  writeTextFile(options.folder / "failures.csv", makeFailuresCsv(run));
  for (const auto& [set, samples] : {std::pair("train", run.train_samples), {"test", run.test_samples}}) {
    requireFewFailures(run.failures, set, samples, experiment.model.simulation.allowed_failures,
                       options.folder);
  }
}

}  // namespace twinmap
