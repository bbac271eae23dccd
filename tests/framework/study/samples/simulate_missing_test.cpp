#include "framework/study/samples/simulate_missing.hpp"

#include <gtest/gtest.h>

#include <cstring>

#include "tests/framework/study/samples/counting_simulator.hpp"
#include "tests/framework/test_folder.hpp"

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
      const TestFolder root;
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
  const TestFolder root;
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
  const TestFolder root;
  TrajectoryStore store = openStore(root.getPath());
  const CountingSimulator simulator;
  const MatrixXd points = makeCountedPoints(6).replicate(1, 3);
  const StoredTrajectories result = simulateMissing(store, simulator, points);
  EXPECT_EQ(simulator.getCount(), 6);
  EXPECT_EQ(result.counts.reused, 12);
  EXPECT_TRUE(areSame(result.trajectories, generateSamples(simulator, points)));
}

TEST(SimulateMissing, AStopFinishesAndWritesWhatIsUnderWay) {
  const TestFolder root;
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
  const TestFolder root;
  TrajectoryStore store = openStore(root.getPath());
  const CountingSimulator simulator({}, 30.0);
  MissingOptions options;
  options.threads = 1;
  EXPECT_THROW(simulateMissing(store, simulator, makeCountedPoints(100), options), std::logic_error);
  EXPECT_EQ(simulator.getCount(), 29);
  EXPECT_EQ(store.getSampleCount(), 29);
}

TEST(SimulateMissing, WritesAChunkAfterItsTimeToo) {
  const TestFolder root;
  TrajectoryStore store = openStore(root.getPath());
  MissingOptions options;
  options.threads = 1;
  options.chunk_seconds = 0.0;
  simulateMissing(store, CountingSimulator(), makeCountedPoints(8), options);
  EXPECT_EQ(countChunks(store), 8);
}

TEST(SimulateMissing, ReportsProgressSampleBySample) {
  const TestFolder root;
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
  const TestFolder root;
  TrajectoryStore store = openStore(root.getPath());
  const StoredTrajectories result = simulateMissing(store, CountingSimulator(), MatrixXd(2, 0));
  EXPECT_EQ(result.trajectories.responses.rows(), 8);
  EXPECT_EQ(result.trajectories.responses.cols(), 0);
}

/// `count` points at which the simulator fails, the first of them 7 * first.
MatrixXd makeFailingPoints(int count, int first = 1) {
  MatrixXd points(2, count);
  for (int i = 0; i < count; ++i) {
    points.col(i) << 7.0 * (i + first), 0.5;
  }
  return points;
}

MissingOptions makeGivingUp(int threads, double allowed_failures = 0.05) {
  MissingOptions options;
  options.threads = threads;
  options.allowed_failures = allowed_failures;
  return options;
}

TEST(GivingUp, EndsAfterADozenForAnyThreadsAndKeepsThem) {
  for (const int threads : {1, 2, 3, 5}) {
    const TestFolder root;
    TrajectoryStore store = openStore(root.getPath());
    const CountingSimulator simulator;
    const StoredTrajectories result =
        simulateMissing(store, simulator, makeFailingPoints(1000), makeGivingUp(threads));
    EXPECT_EQ(simulator.getCount(), 12);
    EXPECT_EQ(store.getSampleCount(), 12);
    EXPECT_EQ(result.counts.failed, 12);
    EXPECT_EQ(result.counts.given_up, 988);
    EXPECT_FALSE(result.stopped);
    EXPECT_EQ(result.trajectories.calcFailureCount(), 1000);
    EXPECT_TRUE(result.trajectories.responses.array().isNaN().all());
    EXPECT_EQ(result.trajectories.statuses[11].reason, "p0 is a multiple of 7");
    EXPECT_EQ(result.trajectories.statuses[12].reason,
              "not simulated, since every sample before failed: p0 is a multiple of 7");
  }
}

TEST(GivingUp, OneSuccessAmongTheDozenIsEnoughToGoOn) {
  for (const int place : {0, 5, 11}) {
    const TestFolder root;
    TrajectoryStore store = openStore(root.getPath());
    const CountingSimulator simulator;
    MatrixXd points = makeFailingPoints(40);
    points(0, place) = 1.0;
    const StoredTrajectories result = simulateMissing(store, simulator, points, makeGivingUp(2));
    EXPECT_EQ(simulator.getCount(), 40);
    EXPECT_EQ(result.counts.given_up, 0);
    EXPECT_EQ(result.counts.failed, 39);
  }
}

TEST(GivingUp, CountsWhatIsStored) {
  const TestFolder root;
  TrajectoryStore store = openStore(root.getPath());
  simulateMissing(store, CountingSimulator(), makeFailingPoints(5));
  const CountingSimulator simulator;
  EXPECT_FALSE(isGivenUp(store, makeFailingPoints(40), 0.05));
  simulateMissing(store, simulator, makeFailingPoints(40), makeGivingUp(2));
  EXPECT_EQ(simulator.getCount(), 7);  // and 5 make a dozen
  EXPECT_TRUE(isGivenUp(store, makeFailingPoints(40), 0.05));
  const StoredTrajectories again = simulateMissing(store, simulator, makeFailingPoints(40), makeGivingUp(2));
  EXPECT_EQ(simulator.getCount(), 7);
  EXPECT_EQ(again.counts.given_up, 28);
  MatrixXd with_success = makeFailingPoints(40);
  with_success(0, 39) = 1.0;
  simulateMissing(store, simulator, with_success.rightCols(1));
  simulateMissing(store, simulator, with_success, makeGivingUp(2));
  EXPECT_EQ(simulator.getCount(), 7 + 1 + 27);
  EXPECT_FALSE(isGivenUp(store, with_success, 0.05));
}

TEST(GivingUp, TakesMoreWhereMoreMayFailAndNeverWhereAllMay) {
  for (const auto& [allowed, simulated] : {std::pair(0.5, 12), {0.9, 79}, {1.0, 200}}) {
    const TestFolder root;
    TrajectoryStore store = openStore(root.getPath());
    const CountingSimulator simulator;
    simulateMissing(store, simulator, makeFailingPoints(200), makeGivingUp(2, allowed));
    EXPECT_EQ(simulator.getCount(), simulated) << allowed;
  }
}

TEST(GivingUp, FewerThanADozenAreAllSimulated) {
  const TestFolder root;
  TrajectoryStore store = openStore(root.getPath());
  const StoredTrajectories result =
      simulateMissing(store, CountingSimulator(), makeFailingPoints(11), makeGivingUp(3));
  EXPECT_EQ(result.counts.simulated, 11);
  EXPECT_EQ(result.counts.given_up, 0);
  EXPECT_FALSE(result.stopped);
}

TEST(GivingUp, WhereSamplesSucceedTheResultIsTheSame) {
  const MatrixXd points = makeCountedPoints(40);
  const Trajectories reference = generateSamples(CountingSimulator(), points);
  for (const int threads : {1, 3}) {
    const TestFolder root;
    TrajectoryStore store = openStore(root.getPath());
    EXPECT_TRUE(areSame(
        simulateMissing(store, CountingSimulator(), points, makeGivingUp(threads)).trajectories, reference));
  }
}

TEST(GivingUp, AStopAmongTheDozenIsAStop) {
  const TestFolder root;
  TrajectoryStore store = openStore(root.getPath());
  std::atomic<bool> stop{false};
  const CountingSimulator simulator([&](double p0) { stop = stop || p0 == 21.0; });
  MissingOptions options = makeGivingUp(1);
  options.stop = &stop;
  const StoredTrajectories result = simulateMissing(store, simulator, makeFailingPoints(40), options);
  EXPECT_TRUE(result.stopped);
  EXPECT_EQ(result.counts.given_up, 0);
  EXPECT_EQ(simulator.getCount(), 3);
}

}  // namespace
}  // namespace twinmap
