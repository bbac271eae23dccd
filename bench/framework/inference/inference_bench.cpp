// What a measurement's inference by a trained map costs, its judgement, and its refinement on the simulator.
// Usage: inference_bench RUN [options of Google Benchmark]; RUN is the folder of a run, the measurements are
// its test samples with noise.
#include <benchmark/benchmark.h>

#include <cstdio>

#include "framework/base/random/random.hpp"
#include "framework/data/noise/noise.hpp"
#include "framework/inference/inferrer.hpp"
#include "framework/inference/refiner.hpp"
#include "framework/store/samples_file.hpp"

namespace twinmap {
namespace {

/// Features of the test samples (d x s), noisy.
Eigen::MatrixXd measure(const Inferrer& inferrer, const std::filesystem::path& run) {
  const Eigen::MatrixXd responses = readSamplesFile(run / "samples.h5").test.responses;
  const ResponseNoise noise(inferrer.getExperiment().noise, inferrer.getLayout());
  const Eigen::MatrixXd measured = noise.add(responses, RandomStream{1, RandomPurpose::kTestNoise}, 0);
  Eigen::MatrixXd features(static_cast<Eigen::Index>(inferrer.getExtractor().getInfos().size()),
                           measured.cols());
  for (Eigen::Index i = 0; i < measured.cols(); ++i) {
    features.col(i) = extractFeatures(inferrer.getExtractor(), measured.col(i), "test sample");
  }
  return features;
}

void benchInference(const Inferrer& inferrer, const Eigen::MatrixXd& measured) {
  const Eigen::VectorXd known;
  benchmark::RegisterBenchmark("infer", [&](benchmark::State& state) {
    const std::unique_ptr<Estimator::Workspace> workspace = inferrer.getMap().makeWorkspace();
    Eigen::Index i = 0;
    for (auto _ : state) {
      benchmark::DoNotOptimize(inferrer.getMap().infer(measured.col(i), known, *workspace).mean.data());
      i = (i + 1) % measured.cols();
    }
  })->Unit(benchmark::kMicrosecond);
  benchmark::RegisterBenchmark("infer and judge", [&](benchmark::State& state) {
    OnlineWorkspace workspace(inferrer.getModel());
    Eigen::Index i = 0;
    for (auto _ : state) {
      benchmark::DoNotOptimize(inferrer.infer(measured.col(i), known, workspace).by_estimator.mean.data());
      i = (i + 1) % measured.cols();
    }
  })->Unit(benchmark::kMicrosecond);
}

void benchRefinement(const Inferrer& inferrer, const SimulatorRefiner& refiner,
                     const Eigen::MatrixXd& measured) {
  benchmark::RegisterBenchmark("infer, judge and refine", [&](benchmark::State& state) {
    const Eigen::VectorXd known;
    OnlineWorkspace workspace(inferrer.getModel());
    const TrustModel* trust = inferrer.getTrustModel() ? &*inferrer.getTrustModel() : nullptr;
    Eigen::Index i = 0, simulations = 0;
    for (auto _ : state) {
      const Eigen::VectorXd features = measured.col(i);
      InferredMeasurement inferred = inferrer.infer(features, known, workspace);
      refiner.refineAndJudge(features, known, trust, inferred);
      simulations += inferred.refined->simulations;
      i = (i + 1) % measured.cols();
    }
    state.counters["simulations"] =
        benchmark::Counter(static_cast<double>(simulations), benchmark::Counter::kAvgIterations);
  })->Unit(benchmark::kMicrosecond);
}

int benchRun(const std::filesystem::path& run) {
  const Inferrer inferrer(run);
  const SimulatorRefiner refiner(inferrer.getExperiment(), inferrer.getLayout());
  const Eigen::MatrixXd measured = measure(inferrer, run);
  benchInference(inferrer, measured);
  benchRefinement(inferrer, refiner, measured);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}

}  // namespace
}  // namespace twinmap

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (argc != 2) {
    std::fprintf(stderr, "usage: inference_bench RUN [options of Google Benchmark]\n");
    return 2;
  }
  return twinmap::benchRun(argv[1]);
}
