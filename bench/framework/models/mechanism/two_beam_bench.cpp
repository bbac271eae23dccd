// One sample of the two-beam case by several ways, each with its largest error against the closed form
// (relative to the output's range, over 50 random parameter sets), and the generation on 1 and 2 threads.

#include <benchmark/benchmark.h>

#include "bench/framework/models/mechanism/naive_simbody.hpp"
#include "framework/models/mechanism/simulator/multibody_simulator.hpp"
#include "framework/simulation/sample_generator.hpp"
#include "tests/framework/models/mechanism/two_beam.hpp"

namespace twinmap::bench {
namespace {

using testing::calcTwoBeamEquilibrium;
using testing::integrateTwoBeam;
using testing::makeTwoBeam;
using testing::makeTwoBeamPoints;
using testing::makeTwoBeamTimes;

constexpr int kPoints = 50;

struct Reference {
  Eigen::VectorXd times = makeTwoBeamTimes();
  Eigen::MatrixXd points = makeTwoBeamPoints(kPoints);
  std::vector<Eigen::MatrixXd> trajectories;

  Reference() {
    for (int j = 0; j < kPoints; ++j) {
      trajectories.push_back(integrateTwoBeam(points.col(j), times));
    }
  }
};

const Reference& getReference() {
  static const Reference reference;
  return reference;
}

/// `simulate(j)` returns (y, theta), 2 x times, of point j.
template <typename Simulate>
double calcLargestError(const Simulate& simulate) {
  double largest = 0.0;
  for (int j = 0; j < kPoints; ++j) {
    const Eigen::MatrixXd& expected = getReference().trajectories[j];
    const Eigen::VectorXd range = expected.rowwise().maxCoeff() - expected.rowwise().minCoeff();
    const Eigen::VectorXd error = (simulate(j) - expected).cwiseAbs().rowwise().maxCoeff();
    largest = std::max(largest, error.cwiseQuotient(range).maxCoeff());
  }
  return largest;
}

template <typename Simulate>
void runSamples(benchmark::State& state, const Simulate& simulate) {
  getReference();
  int j = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(simulate(j));
    j = (j + 1) % kPoints;
  }
  state.counters["largest_error"] = calcLargestError(simulate);
}

void NaiveSimbody(benchmark::State& state) {
  const double theta = calcTwoBeamEquilibrium({1.0, 2e-4, 10.0, 0.036})[1];
  runSamples(state, [&](int j) {
    return simulateNaively(getReference().points.col(j), getReference().times, theta, 1e-7);
  });
}

void Twinmap(benchmark::State& state) {
  ModelSpec model = makeTwoBeam();
  model.simulation.engine = Engine::kSimbody;
  MultibodySimulator simulator(model, getReference().times);
  Eigen::MatrixXd response(2 * getReference().times.size(), 1);
  runSamples(state, [&](int j) {
    SampleStatus status;
    simulator.simulate(getReference().points.col(j), response, &status);
    return Eigen::MatrixXd(response.reshaped(getReference().times.size(), 2).transpose());
  });
}

/// 256 samples in lanes on one thread, with their derivatives or without; time and processor time a sample.
void TwinmapLanes(benchmark::State& state) {
  MultibodySimulator simulator(makeTwoBeam(), makeTwoBeamTimes());
  const Eigen::MatrixXd points = makeTwoBeamPoints(256);
  Eigen::MatrixXd responses(simulator.getLayout().getRowCount(), points.cols()), derivatives;
  std::vector<SampleStatus> statuses(points.cols());
  for (auto _ : state) {
    if (state.range(0) == 1) {
      simulator.simulateWithDerivatives(points, responses, derivatives, statuses.data());
    } else {
      simulator.simulate(points, responses, statuses.data());
    }
  }
  state.counters["us_a_sample"] =
      benchmark::Counter(1e-6 * static_cast<double>(points.cols()),
                         benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void Generate250(benchmark::State& state) {
  const MultibodySimulator simulator(makeTwoBeam(), makeTwoBeamTimes());
  const Eigen::MatrixXd points = makeTwoBeamPoints(250);
  GeneratorOptions options;
  options.threads = static_cast<int>(state.range(0));
  for (auto _ : state) {
    benchmark::DoNotOptimize(generateSamples(simulator, points, options));
  }
}

BENCHMARK(NaiveSimbody)->Unit(benchmark::kMillisecond);
BENCHMARK(Twinmap)->Unit(benchmark::kMillisecond);
BENCHMARK(TwinmapLanes)->ArgName("derivatives")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);
BENCHMARK(Generate250)->ArgName("threads")->Arg(1)->Arg(2)->UseRealTime()->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace twinmap::bench
