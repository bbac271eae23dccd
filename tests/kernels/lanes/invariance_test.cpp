// What a sample gives depends on nothing but itself.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <thread>

#include "tests/kernels/lanes/batch.hpp"

namespace twinmap::lanes {
namespace {

using testing::Batch;
using testing::drawPoints;
using testing::makeTwoBeamOptions;

TEST(Lanes, EveryEngineOrderBatchAndThreadGivesTheSameBits) {
  for (const int directions : {0, 4}) {
    std::vector<int> list{0, 1, 2, 3};
    list.resize(directions);
    const Problem problem = two_beam::makeProblem(list);
    const auto points = drawPoints(23);
    Batch reference;
    for (const auto& point : points) {
      reference.add(two_beam::makeSample(point, directions, nullptr, nullptr), 200, directions);
    }
    Integrator first(problem, two_beam::makeTimes(), makeTwoBeamOptions(directions), kSteps4);
    reference.run(first);
    for (const StepEngine* engine : getEngines()) {
      for (const std::size_t batch_size : {1u, 5u, 23u}) {
        Integrator integrator(problem, two_beam::makeTimes(), makeTwoBeamOptions(directions), *engine);
        for (std::size_t begin = 0; begin < points.size(); begin += batch_size) {
          Batch batch;
          for (std::size_t i = begin; i < std::min(begin + batch_size, points.size()); ++i) {
            batch.samples.insert(batch.samples.begin(), reference.samples[i]);  // backwards
          }
          batch.add(batch.samples.back(), 200, directions);
          batch.samples.pop_back();
          batch.run(integrator);
          const std::size_t count = batch.samples.size();
          for (std::size_t k = 0; k < count; ++k) {
            const std::size_t i = begin + count - 1 - k;
            EXPECT_TRUE(std::equal(&batch.outputs[k * 200], &batch.outputs[k * 200] + 200,
                                   &reference.outputs[i * 200]));
            const std::size_t size = 200 * directions;
            EXPECT_TRUE(std::equal(batch.derivatives.begin() + k * size,
                                   batch.derivatives.begin() + (k + 1) * size,
                                   reference.derivatives.begin() + i * size));
            EXPECT_EQ(batch.results[k].steps, reference.results[i].steps);
          }
        }
      }
    }
  }
}

/// A stream that several integrators share.
class SharedStream : public SampleStream {
 public:
  explicit SharedStream(const std::vector<Sample>& samples) : samples_(samples) {}
  bool next(Sample& sample) override {
    const std::size_t index = next_++;
    if (index < samples_.size()) {
      sample = samples_[index];
    }
    return index < samples_.size();
  }
  void finish(const Sample&, const Result& result) override {
    failures_ += result.outcome == Outcome::kDone ? 0 : 1;
  }
  int getFailures() const { return failures_; }

 private:
  const std::vector<Sample>& samples_;
  std::atomic<std::size_t> next_{0};
  std::atomic<int> failures_{0};
};

TEST(Lanes, ThreadsMayShareAStream) {
  const Problem problem = two_beam::makeProblem();
  Batch batch;
  for (const auto& point : drawPoints(60)) {
    batch.add(two_beam::makeSample(point, 0, nullptr, nullptr), 200, 0);
  }
  Integrator single(problem, two_beam::makeTimes(), {}, chooseEngine(8));
  batch.run(single);
  const std::vector<double> expected = batch.outputs;
  for (const int count : {2, 5}) {
    std::fill(batch.outputs.begin(), batch.outputs.end(), 0.0);
    SharedStream stream(batch.samples);
    std::vector<std::thread> threads;
    for (int i = 0; i < count; ++i) {
      threads.emplace_back(
          [&] { Integrator(problem, two_beam::makeTimes(), {}, chooseEngine(8)).run(stream); });
    }
    for (std::thread& thread : threads) {
      thread.join();
    }
    EXPECT_EQ(stream.getFailures(), 0);
    EXPECT_EQ(batch.outputs, expected);
  }
}

TEST(Lanes, AreKeptBusy) {
  Integrator integrator(two_beam::makeProblem(), two_beam::makeTimes(), {}, chooseEngine(8));
  Batch batch;
  for (const auto& point : drawPoints(200)) {
    batch.add(two_beam::makeSample(point, 0, nullptr, nullptr), 200, 0);
  }
  batch.run(integrator);
  const Statistics& statistics = integrator.getStatistics();
  EXPECT_GT(statistics.active_lanes, 0.98 * statistics.rounds * 8);
}

}  // namespace
}  // namespace twinmap::lanes
