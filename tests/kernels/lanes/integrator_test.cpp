#include "kernels/lanes/integrator.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <random>
#include <thread>

#include "tests/kernels/lanes/oracle.hpp"
#include "tests/kernels/lanes/pendulum.hpp"
#include "tests/kernels/lanes/two_beam.hpp"

namespace twinmap::lanes {
namespace {

using program::Recorder;
using program::Symbol;
using testing::integrateTightly;
using testing::State;

/// Samples of one problem with the memory of their results.
struct Batch {
  std::vector<double> outputs, derivatives;
  std::vector<Sample> samples;
  std::vector<Result> results;

  void add(const Sample& sample, int values, int directions) {
    samples.push_back(sample);
    values_ = values;
    directions_ = directions;
  }
  void run(Integrator& integrator) {
    outputs.assign(samples.size() * values_, -99.0);
    derivatives.assign(samples.size() * values_ * directions_, -99.0);
    for (std::size_t i = 0; i < samples.size(); ++i) {
      samples[i].outputs = outputs.data() + i * values_;
      samples[i].derivatives = derivatives.data() + i * values_ * directions_;
    }
    results = integrate(integrator, samples);
  }

 private:
  int values_ = 0, directions_ = 0;
};

std::vector<std::vector<double>> drawPoints(int count) {
  std::mt19937_64 engine(20221);
  std::uniform_real_distribution<> uniform;
  std::vector<std::vector<double>> points;
  for (int i = 0; i < count; ++i) {
    const double u[4] = {uniform(engine), uniform(engine), uniform(engine), uniform(engine)};
    points.push_back(two_beam::makePoint(u));
  }
  return points;
}

std::vector<State> solveTwoBeam(const std::vector<double>& point) {
  const auto f = [&point](double t, const State& x) {
    const bool on = t > two_beam::kPulseBegin && t < two_beam::kPulseEnd;
    return two_beam::calcDerivatives<double>(x, point, on ? 1.0 : 0.0);
  };
  return integrateTightly(f, {0.0, two_beam::calcEquilibrium(), 0.0, 0.0}, 0.0, two_beam::makeTimes(),
                          {two_beam::kPulseBegin, two_beam::kPulseEnd});
}

Options makeTwoBeamOptions(int directions) {
  Options options;
  if (directions > 0) {
    options.parameter_scales = {0.2, 5e-5, 10.0, 0.018};
  }
  return options;
}

double calcRange(const double* values, int count) {
  const auto [low, high] = std::minmax_element(values, values + count);
  return *high - *low;
}

TEST(Lanes, TwoBeamsAreThoseOfATightIntegration) {
  Batch batch;
  const auto points = drawPoints(20);
  for (const auto& point : points) {
    batch.add(two_beam::makeSample(point, 0, nullptr, nullptr), 200, 0);
  }
  Integrator integrator(two_beam::makeProblem(), two_beam::makeTimes(), {}, chooseEngine(8));
  batch.run(integrator);
  double largest = 0.0;
  for (std::size_t j = 0; j < points.size(); ++j) {
    EXPECT_EQ(batch.results[j].outcome, Outcome::kDone);
    const std::vector<State> expected = solveTwoBeam(points[j]);
    for (int output = 0; output < 2; ++output) {
      const double* const values = &batch.outputs[j * 200 + output * 100];
      for (int i = 0; i < 100; ++i) {
        largest = std::max(largest, std::abs(values[i] - expected[i][output]) / calcRange(values, 100));
      }
    }
  }
  EXPECT_LT(largest, 1.3e-6);  // what the prototype was measured at
  EXPECT_LT(integrator.getStatistics().rejected, 0.02 * integrator.getStatistics().steps);
}

/// Central differences of order 4 of the tight integration; 1e-3 of the box, error about 1e-9 of the range.
TEST(Lanes, SensitivitiesAreTheLimitOfDifferences) {
  const std::vector<int> directions{0, 1, 2, 3};
  Batch batch;
  const auto points = drawPoints(3);
  for (const auto& point : points) {
    batch.add(two_beam::makeSample(point, 4, nullptr, nullptr), 200, 4);
  }
  Integrator integrator(two_beam::makeProblem(directions), two_beam::makeTimes(), makeTwoBeamOptions(4),
                        chooseEngine(8));
  batch.run(integrator);
  double largest = 0.0;
  for (std::size_t j = 0; j < points.size(); ++j) {
    for (int direction = 0; direction < 4; ++direction) {
      const double h = 1e-3 * (two_beam::kUpper[direction] - two_beam::kLower[direction]);
      const auto solveAt = [&](double offset) {
        std::vector<double> point = points[j];
        point[direction] += offset;
        return solveTwoBeam(point);
      };
      const auto a = solveAt(-2 * h), b = solveAt(-h), c = solveAt(h), d = solveAt(2 * h);
      for (int output = 0; output < 2; ++output) {
        const double* const values = &batch.derivatives[((j * 4 + direction) * 2 + output) * 100];
        for (int i = 0; i < 100; ++i) {
          const double expected =
              (8.0 * (c[i][output] - b[i][output]) - (d[i][output] - a[i][output])) / (12.0 * h);
          largest = std::max(largest, std::abs(values[i] - expected) / calcRange(values, 100));
        }
      }
    }
  }
  EXPECT_LT(largest, 1e-4);
}

TEST(Lanes, ValuesWithSensitivitiesAreAsGoodAsThoseAlone) {
  Batch alone, with;
  for (const auto& point : drawPoints(8)) {
    alone.add(two_beam::makeSample(point, 0, nullptr, nullptr), 200, 0);
    with.add(two_beam::makeSample(point, 4, nullptr, nullptr), 200, 4);
  }
  Integrator of_values(two_beam::makeProblem(), two_beam::makeTimes(), {}, chooseEngine(8));
  Integrator of_both(two_beam::makeProblem({0, 1, 2, 3}), two_beam::makeTimes(), makeTwoBeamOptions(4),
                     chooseEngine(8));
  alone.run(of_values);
  with.run(of_both);
  for (std::size_t i = 0; i < alone.outputs.size(); i += 100) {
    const double range = calcRange(&alone.outputs[i], 100);
    for (std::size_t k = i; k < i + 100; ++k) {
      EXPECT_NEAR(alone.outputs[k], with.outputs[k], 3e-6 * range);
    }
  }
}

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

TEST(Lanes, EnergyOfAChainStays) {
  const int masses = 6;
  std::vector<double> times;
  for (int i = 0; i <= 50; ++i) {
    times.push_back(0.1 * i);
  }
  Integrator integrator(pendulum::makeProblem(masses), times, {}, chooseEngine(8));
  Batch batch;
  for (int j = 0; j < 11; ++j) {
    Sample sample;
    sample.parameters = {1.0 + 0.1 * j, 0.5, 9.81};
    sample.initial.assign(2 * masses, 0.0);
    for (int i = 0; i < masses; ++i) {
      sample.initial[i] = 0.1 * j + 0.1 * i;
    }
    sample.phases = {{0.0, {}}};
    sample.end = 5.0;
    batch.add(sample, (masses + 1) * 51, 0);
  }
  batch.run(integrator);
  for (std::size_t j = 0; j < batch.samples.size(); ++j) {
    ASSERT_EQ(batch.results[j].outcome, Outcome::kDone);
    const double* const energy = &batch.outputs[(j * (masses + 1) + masses) * 51];
    for (int i = 0; i < 51; ++i) {
      EXPECT_NEAR(energy[i], energy[0], 1e-4 * std::abs(energy[0]));
    }
  }
}

/// y'' = -w^2 y + gate * t, all of it known: y = A cos(wt) + B sin(wt) + gate t / w^2. The gate opens when
/// the clock reaches `when`, a parameter.
struct Gate {
  static Problem makeProblem(const std::vector<int>& directions) {
    Recorder r;
    Equations equations;
    equations.counts = {2, 2, 1};  // parameters w and when
    const Symbol w = r.parameter(0);
    equations.derivatives = {r.state(1), r.phaseInput(0) * (r.time() + 1.0) - w * w * r.state(0)};
    equations.outputs = {r.state(0), r.state(1) * r.phaseInput(0), equations.derivatives[1]};
    return lanes::makeProblem(r, equations, directions);
  }
  static Sample makeSample(double w, double when, bool moves) {
    Sample sample;
    sample.parameters = {w, when};
    sample.initial = {1.0, 0.0, 0.0, 0.0, 0.0, 0.0};
    sample.phases = {{0.0, {0.0}}, {when, {1.0}}};
    if (moves) {
      sample.phases[1].begin_slopes = {0.0, 1.0};
    }
    sample.end = 3.0;
    return sample;
  }
  /// y, y' at t.
  static std::pair<double, double> solve(double w, double when, double t) {
    if (t < when) {
      return {std::cos(w * t), -w * std::sin(w * t)};
    }
    const double y = std::cos(w * when) - (when + 1.0) / (w * w), v = -w * std::sin(w * when) - 1.0 / (w * w);
    const double c = std::cos(w * (t - when)), s = std::sin(w * (t - when));
    return {y * c + v / w * s + (t + 1.0) / (w * w), -y * w * s + v * c + 1.0 / (w * w)};
  }
};

TEST(Lanes, SolutionAndOutputsFollowThePhases) {
  const std::vector<double> times{0.0, 0.4, 1.25, 1.5, 3.0};
  Integrator integrator(Gate::makeProblem({}), times, {}, chooseEngine(8));
  Batch batch;
  for (int j = 0; j < 9; ++j) {
    batch.add(Gate::makeSample(3.0 + j, 1.25, false), 15, 0);
  }
  batch.run(integrator);
  for (int j = 0; j < 9; ++j) {
    for (int i = 0; i < 5; ++i) {
      const double w = 3.0 + j, t = times[i];
      const auto [y, v] = Gate::solve(w, 1.25, t);
      const double on = t >= 1.25 ? 1.0 : 0.0;  // at the event the phase is the one that begins
      EXPECT_NEAR(batch.outputs[j * 15 + i], y, 1e-5);
      EXPECT_NEAR(batch.outputs[j * 15 + 5 + i], on * v, 1e-4);
      EXPECT_NEAR(batch.outputs[j * 15 + 10 + i], on * (t + 1.0) - w * w * y, 2e-5 * w * w);
    }
  }
}

TEST(Lanes, SensitivitiesJumpWhereAnEventMoves) {
  const std::vector<double> times{0.5, 1.2, 1.9, 3.0};
  Integrator integrator(Gate::makeProblem({0, 1}), times, {}, chooseEngine(8));
  Batch batch;
  for (int j = 0; j < 5; ++j) {
    batch.add(Gate::makeSample(2.0 + j, 1.0 + 0.03 * j, true), 12, 2);
  }
  batch.run(integrator);
  for (int j = 0; j < 5; ++j) {
    for (int i = 0; i < 4; ++i) {
      const double w = 2.0 + j, when = 1.0 + 0.03 * j, h = 1e-5;
      const double by_w =
          (Gate::solve(w + h, when, times[i]).first - Gate::solve(w - h, when, times[i]).first) / (2 * h);
      const double by_when =
          (Gate::solve(w, when + h, times[i]).first - Gate::solve(w, when - h, times[i]).first) / (2 * h);
      EXPECT_NEAR(batch.derivatives[(j * 2 + 0) * 12 + i], by_w, 1e-4);
      EXPECT_NEAR(batch.derivatives[(j * 2 + 1) * 12 + i], by_when, 1e-4);
    }
  }
}

/// y' = scale y^p, whose solution reaches infinity at t = 1 for p = 2 and y(0) = 1; with a pivot that
/// vanishes at t = 1 + q.
struct Hazard {
  static Problem makeProblem() {
    Recorder r;
    Equations equations;
    equations.counts = {1, 3, 0};
    equations.derivatives = {r.parameter(2) * pow(r.state(0), r.parameter(0))};
    equations.pivots = {1.0 + r.parameter(1) - r.time()};
    equations.outputs = {r.state(0)};
    return lanes::makeProblem(r, equations);
  }
  static Sample makeSample(double p, double q, double scale, double initial = 1.0) {
    Sample sample;
    sample.parameters = {p, q, scale};
    sample.initial = {initial};
    sample.phases = {{0.0, {}}};
    sample.end = 2.0;
    return sample;
  }
};

TEST(Lanes, AFailureIsNamedAndItsNeighboursKeepTheirBits) {
  const std::vector<double> times{0.5, 1.0, 2.0};
  const double nan = std::nan("");
  const Sample good = Hazard::makeSample(0.0, 99.0, 1.0);
  const std::vector<std::pair<Sample, Outcome>> bad{
      {Hazard::makeSample(2.0, 99.0, 1.0), Outcome::kStepTooSmall},  // y reaches infinity at t = 1
      {Hazard::makeSample(0.0, 0.5, 1.0), Outcome::kSingular},
      {Hazard::makeSample(0.0, 99.0, nan), Outcome::kNonFinite},
      {Hazard::makeSample(0.0, 99.0, INFINITY), Outcome::kNonFinite},
      {Hazard::makeSample(1.0, 99.0, 1.0, nan), Outcome::kNonFinite},
  };
  for (const StepEngine* engine : getEngines()) {
    Integrator integrator(Hazard::makeProblem(), times, {}, *engine);
    Batch alone;
    alone.add(good, 3, 0);
    alone.run(integrator);
    for (const auto& [sample, outcome] : bad) {
      Batch batch;
      for (int i = 0; i < 40; ++i) {
        batch.add(i % 7 == 3 ? sample : good, 3, 0);
      }
      batch.run(integrator);
      for (int i = 0; i < 40; ++i) {
        if (i % 7 == 3) {
          const Outcome found = batch.results[i].outcome;
          const bool blows_up = outcome == Outcome::kStepTooSmall && found == Outcome::kNonFinite;
          EXPECT_TRUE(found == outcome || blows_up)
              << "expected " << static_cast<int>(outcome) << ", found " << static_cast<int>(found)
              << " at t = " << batch.results[i].time;
          EXPECT_EQ(batch.outputs[i * 3], -99.0) << "nothing is written";
        } else {
          EXPECT_EQ(batch.results[i].outcome, Outcome::kDone);
          EXPECT_TRUE(std::equal(alone.outputs.begin(), alone.outputs.end(), batch.outputs.begin() + i * 3));
        }
      }
    }
  }
}

TEST(Lanes, FailuresHaveTheirTime) {
  Integrator integrator(Hazard::makeProblem(), {2.0}, {}, chooseEngine(8));
  Batch batch;
  batch.add(Hazard::makeSample(2.0, 99.0, 1.0), 1, 0);
  batch.add(Hazard::makeSample(0.0, 0.5, 1.0), 1, 0);
  batch.run(integrator);
  EXPECT_NEAR(batch.results[0].time, 1.0, 1e-6);
  EXPECT_LT(batch.results[1].time, 1.5);
  EXPECT_GT(batch.results[1].time, 0.0);
}

TEST(Lanes, StepsAreLimited) {
  Options options;
  options.max_steps = 20;
  Integrator integrator(two_beam::makeProblem(), two_beam::makeTimes(), options, chooseEngine(8));
  Batch batch;
  batch.add(two_beam::makeSample(drawPoints(1)[0], 0, nullptr, nullptr), 200, 0);
  batch.run(integrator);
  EXPECT_EQ(batch.results[0].outcome, Outcome::kStepLimit);
  EXPECT_EQ(batch.results[0].steps, 20);
  EXPECT_GT(batch.results[0].time, 0.0);
}

TEST(Lanes, WallTimeIsLimited) {
  Options options;
  options.max_wall_time = 1e-9;
  Integrator integrator(two_beam::makeProblem(), two_beam::makeTimes(), options, chooseEngine(8));
  Batch batch;
  batch.add(two_beam::makeSample(drawPoints(1)[0], 0, nullptr, nullptr), 200, 0);
  batch.run(integrator);
  EXPECT_EQ(batch.results[0].outcome, Outcome::kWallTime);
  EXPECT_EQ(batch.results[0].time, 0.0);
}

TEST(Lanes, SystemAtRestAndAnIntegratorUsedTwice) {
  Recorder r;
  Equations equations;
  equations.counts = {1, 0, 0};
  equations.derivatives = {-r.state(0)};
  equations.outputs = {r.state(0), 5.0};
  Integrator integrator(makeProblem(r, equations), {0.0, 1.0}, {}, chooseEngine(8));
  for (const double initial : {0.0, 2.0}) {
    Sample sample;
    sample.initial = {initial};
    sample.phases = {{0.0, {}}};
    sample.end = 1.0;
    Batch batch;
    batch.add(sample, 4, 0);
    batch.run(integrator);
    EXPECT_EQ(batch.outputs[0], initial);
    EXPECT_NEAR(batch.outputs[1], initial * std::exp(-1.0), 1e-6);
    EXPECT_EQ(batch.outputs[3], 5.0);
  }
  EXPECT_EQ(integrate(integrator, {}).size(), 0u);
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
