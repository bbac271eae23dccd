#include "framework/sampling/simulate_missing.hpp"

#include "framework/sampling/chunk_saver.hpp"

namespace twinmap {
namespace {

void flushQuietly(ChunkSaver& saver) {
  try {
    saver.flush();
  } catch (const std::exception&) {
    // The exception that ended the simulations is the one to report.
  }
}

void simulateAll(const Simulator& simulator, const Eigen::MatrixXd& points, const MissingOptions& options,
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
  saver.flush();
}

Trajectories loadTrajectories(const TrajectoryStore& store, const ResponseLayout& layout,
                              const Eigen::MatrixXd& points) {
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

SimulationProgress storeMissing(TrajectoryStore& store, const Simulator& simulator,
                                const Eigen::MatrixXd& points, const MissingOptions& options) {
  const std::vector<Eigen::Index> missing = store.findMissing(points);
  SimulationProgress counts;
  counts.total = static_cast<int>(missing.size());
  counts.reused = static_cast<int>(points.cols()) - counts.total;
  ChunkSaver saver(store, options, counts);
  simulateAll(simulator, points(Eigen::all, missing), options, saver);
  return saver.getCounts();
}

StoredTrajectories simulateMissing(TrajectoryStore& store, const Simulator& simulator,
                                   const Eigen::MatrixXd& points, const MissingOptions& options) {
  const SimulationProgress counts = storeMissing(store, simulator, points, options);
  return {loadTrajectories(store, simulator.getLayout(), points), counts, counts.simulated < counts.total};
}

}  // namespace twinmap
