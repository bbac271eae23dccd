// What a sample by an FMU in a process of its own costs beside the model itself: an FMU that answers at once
// with 200 values, and the two beams of 5 s.
#include <benchmark/benchmark.h>

#include <cstdlib>

#include "framework/models/fmu/fmu_simulator.hpp"

namespace twinmap {
namespace {

std::string findFmu(const std::string& name) {
  return std::string(TWINMAP_TEST_FMUS) + "/" + name + ".fmu";
}

OutputSpec makeOutput(const std::string& name, const std::string& unit = "") {
  OutputSpec output;
  output.name = {name, {}};
  output.variable = Name{name, {}};
  output.unit = unit;
  return output;
}

void simulateRepeatedly(benchmark::State& state, const ModelSpec& model, const Eigen::VectorXd& times,
                        const Eigen::VectorXd& point) {
  setenv("TWINMAP_WORKER", TWINMAP_EXECUTABLE, 1);
  FmuSimulator simulator(model, times, 0);
  Eigen::MatrixXd response(simulator.getLayout().getRowCount(), 1);
  SampleStatus status;
  for (auto _ : state) {
    simulator.simulate(point, response, &status);
    if (!status.ok) {
      state.SkipWithError(status.reason.c_str());
    }
  }
}

/// A hundred elements of two outputs at time 0 are read, and nothing is simulated.
void answerAtOnce(benchmark::State& state) {
  ModelSpec model;
  model.source.emplace().fmu.emplace().file = {findFmu("feedthrough_3"), {}};
  model.parameters = {{{"single", {}}, {0.0, 1.0, {}}, "", "", RelativeTo::kRange, {}}};
  for (int i = 0; i < 200; ++i) {
    model.outputs.push_back(makeOutput("b[2]"));
    model.outputs.back().name.text = "output" + std::to_string(i);
  }
  model.simulation.duration = 1.0;
  simulateRepeatedly(state, model, Eigen::VectorXd::Zero(1), Eigen::VectorXd::Constant(1, 0.5));
}
BENCHMARK(answerAtOnce)->Unit(benchmark::kMicrosecond)->UseRealTime();

void simulateTwoBeam(benchmark::State& state, const char* fmu, FmuKind kind) {
  ModelSpec model;
  FmuSpec& source = model.source.emplace().fmu.emplace();
  source.file = {findFmu(fmu), {}};
  source.kind = kind;
  model.parameters = {{{"k_y", {}}, {5.0, 15.0, {}}, "N/m", "", RelativeTo::kValue, {}}};
  model.outputs = {makeOutput("y", "m"), makeOutput("theta", "rad")};
  model.simulation.duration = 5.0;
  simulateRepeatedly(state, model, Eigen::VectorXd::LinSpaced(100, 0.05, 5.0),
                     Eigen::VectorXd::Constant(1, 7.0));
}
BENCHMARK_CAPTURE(simulateTwoBeam, co_simulation, "two_beam_2", FmuKind::kCoSimulation)
    ->Unit(benchmark::kMicrosecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(simulateTwoBeam, model_exchange, "two_beam_3", FmuKind::kModelExchange)
    ->Unit(benchmark::kMicrosecond)
    ->UseRealTime();

}  // namespace
}  // namespace twinmap
