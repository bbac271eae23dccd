// Networks of inverse maps: a step of training, and what an inference costs from its features on.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>

#include "kernels/linalg/paired_matrix.hpp"
#include "kernels/network/predictor.hpp"
#include "kernels/network/train.hpp"

namespace twinmap::network {
namespace {

MatrixXd makeNumbers(Index rows, Index cols) {
  return MatrixXd::NullaryExpr(rows, cols, [](Index i, Index j) {
    return std::sin(static_cast<double>(7 * i + 3 * j) + 0.1 * static_cast<double>(i * j % 97));
  });
}

Network makeSized(Index inputs, Index targets, int units) {
  return makeNetwork(makeNumbers(inputs, 500), makeNumbers(targets, 500),
                     {{units, units}, 1e-3, {std::min<Index>(inputs, 12), std::min<Index>(inputs, 8)}},
                     [](Index i) { return std::sin(static_cast<double>(i)); });
}

/// A batch of 256 samples, the optimiser's part included; its drawing is not.
void trainStep(benchmark::State& state) {
  const Index inputs = state.range(1), targets = 4, steps = 50;
  const MatrixXd drawn = makeNumbers(inputs, 64), wanted = makeNumbers(targets, 64);
  const auto source = [&](Index, Index, Samples& samples) {
    samples.inputs = drawn;
    samples.targets = wanted;
  };
  const Samples held_out{makeNumbers(inputs, 64), makeNumbers(targets, 64)};
  TrainingOptions options;
  options.steps = steps;
  options.check_interval = steps;
  const Network initial = makeSized(inputs, targets, static_cast<int>(state.range(0)));
  for (auto _ : state) {
    benchmark::DoNotOptimize(trainNetwork(initial, source, held_out, options));
  }
  state.counters["per_step"] = benchmark::Counter(static_cast<double>(state.iterations() * steps),
                                                  benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK(trainStep)->Args({64, 20})->Args({192, 60})->Args({256, 100})->Unit(benchmark::kMillisecond);

/// Mean, stddev and covariance of parameters from features: their projection, then the network.
void infer(benchmark::State& state) {
  const Index features = 200, inputs = state.range(0), targets = state.range(1);
  const Predictor predictor(makeSized(inputs, targets, static_cast<int>(state.range(2))));
  Predictor::Workspace workspace(predictor);
  const linalg::PairedMatrix projection(makeNumbers(inputs, features));
  const VectorXd center = makeNumbers(features, 1), measured = makeNumbers(features, 1);
  VectorXd centered(features), projected(inputs);
  for (auto _ : state) {
    centered = measured - center;
    projection.multiply(centered.data(), projected.data());
    predictor.predict(projected, workspace);
    benchmark::DoNotOptimize(workspace.covariance.data());
    benchmark::ClobberMemory();
  }
}
BENCHMARK(infer)
    ->Args({8, 4, 64})
    ->Args({12, 4, 64})
    ->Args({16, 4, 64})
    ->Args({32, 4, 64})
    ->Args({30, 8, 64})
    ->Args({30, 5, 192});

}  // namespace
}  // namespace twinmap::network
