// Run with --benchmark_filter=... ; complexity is fitted over n. Arguments: n, features, per-feature length
// scales (0 or 1), threads where they matter.
#include <benchmark/benchmark.h>

#include "bench/kernels/problem.hpp"
#include "kernels/gp/fit.hpp"
#include "kernels/gp/online/online_predictor.hpp"
#include "kernels/gp/training.hpp"

namespace twinmap::bench {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

void gemmRate(benchmark::State& state) {
  const Eigen::Index n = state.range(0);
  const MatrixXd a = MatrixXd::Random(n, n), b = MatrixXd::Random(n, n);
  MatrixXd c(n, n);
  linalg::GemmScratch scratch;
  for (auto _ : state) {
    linalg::gemm(1.0, linalg::viewOf(a), linalg::viewOf(b), 0.0, linalg::viewOf(c), scratch);
    benchmark::DoNotOptimize(c.data());
  }
  state.counters["flops"] = benchmark::Counter(2.0 * double(n) * double(n) * double(n),
                                               benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(gemmRate)->Arg(250)->Arg(1000)->Arg(4000)->Unit(benchmark::kMillisecond);

void evaluate(benchmark::State& state) {
  const int n = static_cast<int>(state.range(0)), features = static_cast<int>(state.range(1));
  const bool per_feature = state.range(2) != 0;
  const Problem problem = makeProblem(n, features);
  const gp::ModelStructure structure = makeStructure(features, per_feature);
  const gp::Hyperparameters hyperparameters = makeHyperparameters(features, per_feature);
  const gp::TrainingSet set(problem.inputs, structure);
  gp::LikelihoodWorkspace workspace(set, static_cast<int>(state.range(3)));
  VectorXd gradient(gp::HyperparameterLayout(structure).count);
  const VectorXd target = problem.targets.row(0).transpose();
  for (auto _ : state) {
    gp::evaluateLikelihoodGradient(set, target, hyperparameters, workspace, gradient);
    benchmark::DoNotOptimize(gradient.data());
  }
  state.SetComplexityN(n);
  state.counters["flops"] =
      benchmark::Counter(double(n) * n * n, benchmark::Counter::kIsIterationInvariantRate);
}

void evaluateArguments(benchmark::internal::Benchmark* bench, int features, int per_feature, int threads) {
  for (int n : {100, 250, 500, 1000, 2000, 4000}) {
    bench->Args({n, features, per_feature, threads});
  }
  bench->Complexity(benchmark::oNCubed)->Unit(benchmark::kMillisecond)->UseRealTime();
}
#define TWINMAP_EVALUATE(features, per_feature, threads)                               \
  BENCHMARK(evaluate)                                                                  \
      ->Name("evaluate/features:" #features "/ard:" #per_feature "/threads:" #threads) \
      ->Apply([](auto* bench) { evaluateArguments(bench, features, per_feature, threads); })
TWINMAP_EVALUATE(8, 0, 1);
TWINMAP_EVALUATE(16, 0, 1);
TWINMAP_EVALUATE(16, 1, 1);
TWINMAP_EVALUATE(200, 0, 1);
TWINMAP_EVALUATE(200, 1, 1);
TWINMAP_EVALUATE(16, 0, 2);
TWINMAP_EVALUATE(200, 1, 2);

void trainFourMaps(benchmark::State& state) {
  const Problem problem = makeProblem(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)));
  gp::TrainingOptions options;
  options.starts = static_cast<int>(state.range(2));
  options.threads = static_cast<int>(state.range(3));
  const gp::ModelStructure structure = makeStructure(static_cast<int>(state.range(1)), false);
  for (auto _ : state) {
    benchmark::DoNotOptimize(gp::train(problem.inputs, problem.targets, structure, options));
  }
}
BENCHMARK(trainFourMaps)
    ->ArgNames({"n", "features", "starts", "threads"})
    ->ArgsProduct({{250}, {200}, {1, 4}, {1, 2}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

void predictOnline(benchmark::State& state) {
  const int n = static_cast<int>(state.range(0)), features = static_cast<int>(state.range(1));
  const bool per_feature = state.range(2) != 0;
  const Problem problem = makeProblem(n, features);
  std::vector<gp::Process> processes;
  const auto inputs = std::make_shared<const MatrixXd>(problem.inputs);
  for (int t = 0; t < 4; ++t) {
    const auto fitted =
        gp::fit(problem.inputs, problem.targets.row(t).transpose(), makeStructure(features, per_feature),
                makeHyperparameters(features, per_feature));
    gp::GaussianProcessParts parts = fitted->getParts();
    parts.inputs = inputs;
    processes.push_back(std::make_shared<const gp::GaussianProcess>(parts));
  }
  const gp::OnlinePredictor predictor(processes);
  gp::OnlinePredictor::Workspace workspace(predictor);
  Eigen::Index i = 0;
  for (auto _ : state) {
    predictor.predict(problem.inputs.col(i), workspace);
    benchmark::DoNotOptimize(workspace.values.stddev.data());
    i = (i + 1) % n;
  }
}
BENCHMARK(predictOnline)
    ->ArgNames({"n", "features", "ard"})
    ->ArgsProduct({{250, 1000}, {15, 200}, {0, 1}})
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace twinmap::bench
