#include <benchmark/benchmark.h>

#include "framework/models/external/program_simulator.hpp"
#include "framework/simulation/sample_generator.hpp"

namespace twinmap {
namespace {

/// 200 values a sample.
ModelSpec makeModel(const std::string& program) {
  ModelSpec model;
  ParameterSpec parameter;
  parameter.name.text = "a";
  parameter.bounds.lower = 1.0;
  parameter.bounds.upper = 2.0;
  model.parameters = {parameter};
  for (const char* name : {"x", "y"}) {
    OutputSpec output;
    output.name.text = name;
    output.variable = output.name;
    model.outputs.push_back(output);
  }
  model.simulation.duration = 5.0;
  model.source = SourceSpec{};
  model.source->program.emplace();
  model.source->program->command = {"/usr/bin/python3", program};
  model.source->program->working_folder = TWINMAP_SOURCE_DIR "/bench/framework/models/external";
  model.source->program->timeout = 0.5;
  return model;
}

const Eigen::VectorXd kTimes = Eigen::VectorXd::LinSpaced(100, 0.05, 5.0);

/// What a sample costs beside the program's own work.
void simulateOneByOne(benchmark::State& state, const std::string& program) {
  ProgramSimulator simulator(makeModel(program), kTimes, 0);
  simulator.checkStart();
  Eigen::MatrixXd response(200, 1);
  const Eigen::MatrixXd point = Eigen::MatrixXd::Constant(1, 1, 1.5);
  SampleStatus status;
  for (auto _ : state) {
    simulator.simulate(point, response, &status);
  }
}
BENCHMARK_CAPTURE(simulateOneByOne, instant, "instant.py")->Unit(benchmark::kMicrosecond)->UseRealTime();
BENCHMARK_CAPTURE(simulateOneByOne, converting, "converting.py")
    ->Unit(benchmark::kMicrosecond)
    ->UseRealTime();

/// 10000 samples by a program that crashes, hangs, answers NaN and leaks.
void simulateTroubled(benchmark::State& state) {
  const ModelSpec model = makeModel("troubled.py");
  const Eigen::MatrixXd points = Eigen::RowVectorXd::LinSpaced(10000, 1.0, 2.0);
  GeneratorOptions options;
  options.threads = static_cast<int>(state.range(0));
  int failures = 0;
  for (auto _ : state) {
    failures = generateSamples(ProgramSimulator(model, kTimes, 0), points, options).calcFailureCount();
  }
  state.counters["failures"] = failures;
}
BENCHMARK(simulateTroubled)->Arg(1)->Arg(2)->Iterations(1)->Unit(benchmark::kSecond)->UseRealTime();

}  // namespace
}  // namespace twinmap
