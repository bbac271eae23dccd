#include "framework/sampling/simulate_missing.hpp"

#include <gtest/gtest.h>

#include <cstring>

#include "tests/framework/sampling/counting_simulator.hpp"
#include "tests/framework/temporary_folder.hpp"

namespace twinmap {
namespace {

namespace fs = std::filesystem;
using Eigen::Index;
using Eigen::MatrixXd;

TrajectoryStore openStore(const fs::path& root) {
  return TrajectoryStore(root, "counting", 2, CountingSimulator().getLayout().getRowCount());
}

bool areSame(const Trajectories& a, const Trajectories& b) {
  for (std::size_t i = 0; i < a.statuses.size(); ++i) {
    if (a.statuses[i].ok != b.statuses[i].ok || a.statuses[i].reason != b.statuses[i].reason) {
      return false;
    }
  }
  return a.parameters == b.parameters && a.responses.size() == b.responses.size() &&
         std::memcmp(a.responses.data(), b.responses.data(), a.responses.size() * sizeof(double)) == 0;
}

int countChunks(const TrajectoryStore& store) {
  int chunks = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(store.getFolder())) {
    chunks += entry.path().extension() == ".chunk" ? 1 : 0;
  }
  return chunks;
}

TEST(SimulateMissing, GivesWhatGenerateSamplesGivesForAnyThreadsAndChunkSize) {
  const MatrixXd points = makeCountedPoints(40);
  const Trajectories reference = generateSamples(CountingSimulator(), points);
  EXPECT_EQ(reference.calcFailureCount(), 5);
  for (const int threads : {1, 2, 3, 5}) {
    for (const int chunk : {1, 3, 16, 1000}) {
      const TemporaryFolder root;
      TrajectoryStore store = openStore(root.getPath());
      MissingOptions options;
      options.threads = threads;
      options.chunk_samples = chunk;
      const StoredTrajectories result = simulateMissing(store, CountingSimulator(), points, options);
      EXPECT_TRUE(areSame(result.trajectories, reference)) << threads << " " << chunk;
      EXPECT_EQ(result.trajectories.layout.output_names, reference.layout.output_names);
      EXPECT_EQ(countChunks(store), (40 + chunk - 1) / chunk);
      EXPECT_FALSE(result.stopped);
    }
  }
}

TEST(SimulateMissing, SimulatesOnlyWhatIsNotStored) {
  const TemporaryFolder root;
  const CountingSimulator simulator;
  {
    TrajectoryStore store = openStore(root.getPath());
    const StoredTrajectories first = simulateMissing(store, simulator, makeCountedPoints(30));
    EXPECT_EQ(first.counts.simulated, 30);
    EXPECT_EQ(first.counts.failed, 4);
    EXPECT_EQ(first.counts.reused, 0);
  }
  TrajectoryStore store = openStore(root.getPath());
  const StoredTrajectories larger = simulateMissing(store, simulator, makeCountedPoints(50));
  EXPECT_EQ(larger.counts.simulated, 20);
  EXPECT_EQ(larger.counts.reused, 30);
  EXPECT_EQ(simulator.getCount(), 50);
  EXPECT_TRUE(areSame(larger.trajectories, generateSamples(CountingSimulator(), makeCountedPoints(50))));
  simulateMissing(store, simulator, makeCountedPoints(25, 10));
  EXPECT_EQ(simulator.getCount(), 50);
}

TEST(SimulateMissing, SimulatesEqualPointsOnce) {
  const TemporaryFolder root;
  TrajectoryStore store = openStore(root.getPath());
  const CountingSimulator simulator;
  const MatrixXd points = makeCountedPoints(6).replicate(1, 3);
  const StoredTrajectories result = simulateMissing(store, simulator, points);
  EXPECT_EQ(simulator.getCount(), 6);
  EXPECT_EQ(result.counts.reused, 12);
  EXPECT_TRUE(areSame(result.trajectories, generateSamples(simulator, points)));
}

TEST(SimulateMissing, AStopFinishesAndWritesWhatIsUnderWay) {
  const TemporaryFolder root;
  TrajectoryStore store = openStore(root.getPath());
  std::atomic<bool> stop{false};
  const CountingSimulator simulator([&](double p0) { stop = stop || p0 == 20.0; });
  MissingOptions options;
  options.threads = 2;
  options.stop = &stop;
  const MatrixXd points = makeCountedPoints(1000);
  const StoredTrajectories stopped = simulateMissing(store, simulator, points, options);
  EXPECT_TRUE(stopped.stopped);
  EXPECT_LT(simulator.getCount(), 1000);
  EXPECT_EQ(store.getSampleCount(), simulator.getCount());
  EXPECT_EQ(stopped.trajectories.statuses[999].reason, "not simulated");
  stop = false;
  const StoredTrajectories continued = simulateMissing(store, CountingSimulator(), points, options);
  EXPECT_FALSE(continued.stopped);
  EXPECT_EQ(continued.counts.simulated, 1000 - simulator.getCount());
  EXPECT_TRUE(areSame(continued.trajectories, generateSamples(CountingSimulator(), points)));
}

TEST(SimulateMissing, ABugIsThrownAgainAndWhatWasFinishedIsKept) {
  const TemporaryFolder root;
  TrajectoryStore store = openStore(root.getPath());
  const CountingSimulator simulator({}, 30.0);
  MissingOptions options;
  options.threads = 1;
  EXPECT_THROW(simulateMissing(store, simulator, makeCountedPoints(100), options), std::logic_error);
  EXPECT_EQ(simulator.getCount(), 29);
  EXPECT_EQ(store.getSampleCount(), 29);
}

TEST(SimulateMissing, WritesAChunkAfterItsTimeToo) {
  const TemporaryFolder root;
  TrajectoryStore store = openStore(root.getPath());
  MissingOptions options;
  options.threads = 1;
  options.chunk_seconds = 0.0;
  simulateMissing(store, CountingSimulator(), makeCountedPoints(8), options);
  EXPECT_EQ(countChunks(store), 8);
}

TEST(SimulateMissing, ReportsProgressSampleBySample) {
  const TemporaryFolder root;
  TrajectoryStore store = openStore(root.getPath());
  simulateMissing(store, CountingSimulator(), makeCountedPoints(4));
  int calls = 0;
  MissingOptions options;
  options.threads = 3;
  options.progress = [&](const SimulationProgress& progress) {
    EXPECT_EQ(progress.simulated, ++calls);
    EXPECT_EQ(progress.total, 16);
    EXPECT_EQ(progress.reused, 4);
  };
  EXPECT_EQ(simulateMissing(store, CountingSimulator(), makeCountedPoints(20), options).counts.failed, 2);
  EXPECT_EQ(calls, 16);
}

TEST(SimulateMissing, NoPointsGiveNoColumns) {
  const TemporaryFolder root;
  TrajectoryStore store = openStore(root.getPath());
  const StoredTrajectories result = simulateMissing(store, CountingSimulator(), MatrixXd(2, 0));
  EXPECT_EQ(result.trajectories.responses.rows(), 8);
  EXPECT_EQ(result.trajectories.responses.cols(), 0);
}

}  // namespace
}  // namespace twinmap
