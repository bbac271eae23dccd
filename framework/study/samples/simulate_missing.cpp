#include "framework/study/samples/simulate_missing.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "framework/study/samples/chunk_saver.hpp"
#include "framework/study/samples/model_store.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

void flushQuietly(ChunkSaver& saver) {
  try {
    saver.flush();
  } catch (const std::exception&) {
    // The exception that ended the simulations is the one to report.
  }
}

void simulateAll(const Simulator& simulator, const MatrixXd& points, const MissingOptions& options,
                 ChunkSaver& saver) {
  GeneratorOptions generator;
  generator.threads = options.threads;
  generator.stop = options.stop;
  generator.finished = [&](const Trajectories& all, int first, int count) { saver.add(all, first, count); };
  try {
    generateSamples(simulator, points, generator);
  } catch (...) {
    flushQuietly(saver);
    throw;
  }
}

/// How many failures in a row say that all will fail: a dozen, or as many as are as unlikely where more than
/// half of the samples may fail. None do where all may.
int calcProbeSize(double allowed_failures) {
  constexpr double kDozen = 12.0, kHalf = 0.5;
  if (allowed_failures >= 1.0) {
    return std::numeric_limits<int>::max();
  }
  const double allowed = std::max(allowed_failures, kHalf);
  return static_cast<int>(std::ceil(std::min(kDozen * std::log(kHalf) / std::log(allowed), 1e9)));
}

/// What the store knows of some points.
struct StoredOutcome {
  int succeeded = 0, failed = 0;
};

StoredOutcome countStored(const TrajectoryStore& store, const MatrixXd& points) {
  StoredOutcome outcome;
  for (const auto& point : points.colwise()) {
    if (store.contains(point)) {
      ++(store.hasFailed(point) ? outcome.failed : outcome.succeeded);
    }
  }
  return outcome;
}

/// Simulates only so many points as show, with what is stored, whether all fail. True if they do.
bool probe(const Simulator& simulator, const MatrixXd& missing, const StoredOutcome& stored,
           const MissingOptions& options, ChunkSaver& saver) {
  const int needed = calcProbeSize(options.allowed_failures) - stored.failed;
  simulateAll(simulator, missing.leftCols(std::clamp<Index>(needed, 0, missing.cols())), options, saver);
  const SimulationProgress& done = saver.getCounts();
  return done.failed == done.simulated && done.failed >= needed;
}

/// Simulates the missing points, or gives up. Returns how many it gave up.
int simulateOrGiveUp(const Simulator& simulator, const MatrixXd& missing, const StoredOutcome& stored,
                     const MissingOptions& options, ChunkSaver& saver) {
  const bool doubtful = stored.succeeded == 0 && options.allowed_failures < 1.0;
  const bool all_fail = doubtful && probe(simulator, missing, stored, options, saver);
  const Index left = missing.cols() - saver.getCounts().simulated;
  if (!all_fail) {
    simulateAll(simulator, missing.rightCols(left), options, saver);
  }
  return all_fail ? static_cast<int>(left) : 0;
}

/// Gives samples that were given up their reason.
void explainGivenUp(const MatrixXd& points, const TrajectoryStore& store,
                    std::vector<SampleStatus>& statuses) {
  std::string reason;
  for (Index i = 0; i < points.cols() && reason.empty(); ++i) {
    reason = store.contains(points.col(i)) ? statuses[i].reason : "";
  }
  for (Index i = 0; i < points.cols(); ++i) {
    if (!store.contains(points.col(i))) {
      statuses[i].reason = fmt::format("not simulated, since every sample before failed: {}", reason);
    }
  }
}

Trajectories loadTrajectories(const TrajectoryStore& store, const ResponseLayout& layout,
                              const MatrixXd& points) {
  SampleBlock block = store.load(points);
  Trajectories trajectories;
  trajectories.layout = layout;
  trajectories.parameters = std::move(block.parameters);
  trajectories.responses = std::move(block.responses);
  trajectories.statuses = std::move(block.statuses);
  return trajectories;
}

}  // namespace

MissingOptions makeMissingOptions(const std::string& stage, int simulations, const RunControl& control) {
  MissingOptions missing;
  missing.threads = control.threads;
  missing.stop = control.stop;
  if (control.progress) {
    missing.progress = [stage, simulations, progress = control.progress](const SimulationProgress& counts) {
      progress({stage, simulations * counts.simulated, simulations * counts.total,
                simulations * counts.failed, double(counts.simulated) / counts.total, true});
    };
  }
  return missing;
}

SimulationProgress storeMissing(TrajectoryStore& store, const Simulator& simulator, const MatrixXd& points,
                                const MissingOptions& options) {
  const std::size_t set_aside = store.getSetAside().size();
  store.refresh();
  store.verify(points);
  logSetAside(store, set_aside);
  const std::vector<Index> missing = store.findMissing(points);
  SimulationProgress counts;
  counts.total = static_cast<int>(missing.size());
  counts.reused = static_cast<int>(points.cols()) - counts.total;
  ChunkSaver saver(store, options, counts);
  const int given_up =
      simulateOrGiveUp(simulator, points(Eigen::all, missing), countStored(store, points), options, saver);
  saver.flush();
  counts = saver.getCounts();
  counts.given_up = given_up;
  return counts;
}

bool isGivenUp(const TrajectoryStore& store, const MatrixXd& points, double allowed_failures) {
  const StoredOutcome stored = countStored(store, points);
  return stored.succeeded == 0 && stored.failed >= calcProbeSize(allowed_failures);
}

StoredTrajectories simulateMissing(TrajectoryStore& store, const Simulator& simulator, const MatrixXd& points,
                                   const MissingOptions& options) {
  const SimulationProgress counts = storeMissing(store, simulator, points, options);
  StoredTrajectories result{loadTrajectories(store, simulator.getLayout(), points), counts,
                            counts.simulated + counts.given_up < counts.total};
  if (counts.given_up > 0) {
    explainGivenUp(points, store, result.trajectories.statuses);
  }
  return result;
}

}  // namespace twinmap
