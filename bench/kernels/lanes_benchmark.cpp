// The two-beam case, its closed-form equations recorded by hand: cost a sample of values alone and with four
// derivatives, and the largest error against a tight integration, in parts of the range.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "kernels/lanes/program/trigonometric.hpp"
#include "tests/kernels/lanes/pendulum.hpp"
#include "tests/kernels/lanes/two_beam.hpp"

namespace twinmap::lanes {
namespace {

constexpr int kSamples = 256;
constexpr int kValues = 200;

struct Points {
  std::vector<std::vector<double>> points;
  Points() {
    std::mt19937_64 engine(1);
    std::uniform_real_distribution<> uniform;
    for (int i = 0; i < kSamples; ++i) {
      const double u[4] = {uniform(engine), uniform(engine), uniform(engine), uniform(engine)};
      points.push_back(two_beam::makePoint(u));
    }
  }
};

const std::vector<std::vector<double>>& getPoints() {
  static const Points points;
  return points.points;
}

/// All samples and the memory of their results.
struct Batch {
  std::vector<double> outputs, derivatives;
  std::vector<Sample> samples;
  explicit Batch(int directions) : outputs(kSamples * kValues), derivatives(kSamples * kValues * directions) {
    for (int i = 0; i < kSamples; ++i) {
      samples.push_back(two_beam::makeSample(getPoints()[i], directions, &outputs[i * kValues],
                                             derivatives.data() + i * kValues * directions));
    }
  }
};

double calcLargestError(const std::vector<double>& values, const std::vector<double>& expected) {
  double largest = 0.0;
  for (std::size_t begin = 0; begin < values.size(); begin += 100) {
    const auto from = expected.begin() + begin;
    const auto [low, high] = std::minmax_element(from, from + 100);
    for (std::size_t i = begin; i < begin + 100; ++i) {
      largest = std::max(largest, std::abs(values[i] - expected[i]) / (*high - *low));
    }
  }
  return largest;
}

/// The same at tolerances of 1e-12 and 1e-14.
const Batch& getReference(int directions) {
  static std::map<int, Batch> references;
  const auto found = references.find(directions);
  if (found != references.end()) {
    return found->second;
  }
  Batch& batch = references.emplace(directions, Batch(directions)).first->second;
  Options options;
  options.relative_tolerance = 1e-12;
  options.absolute_tolerance = 1e-14;
  options.parameter_scales = std::vector<double>{0.2, 5e-5, 10.0, 0.018};
  options.parameter_scales.resize(directions);
  std::vector<int> list{0, 1, 2, 3};
  list.resize(directions);
  Integrator integrator(two_beam::makeProblem(list), two_beam::makeTimes(), options, chooseEngine(kSamples));
  integrate(integrator, batch.samples);
  return batch;
}

[[maybe_unused]] const Problem& getTwoBeamProblem() {
  static const Problem problem = two_beam::makeProblem();
  return problem;
}

void setCounters(benchmark::State& state, const Problem& problem, const Statistics& s,
                 const StepEngine& engine) {
  state.counters["us_a_sample"] = benchmark::Counter(
      kSamples * state.iterations() * 1e-6, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
  state.counters["instructions"] = problem.derivative.evaluation.instructions.size();
  state.counters["dispatches"] = problem.derivative.evaluation.runs.size();
  state.counters["slots"] = problem.derivative.slot_count;
  state.counters["steps"] = double(s.steps) / (kSamples * state.iterations());
  state.counters["rejected_pct"] = 100.0 * s.rejected / s.steps;
  state.counters["active_pct"] = 100.0 * s.active_lanes / (s.rounds * engine.program.lanes);
}

void runTwoBeam(benchmark::State& state, int directions, const StepEngine& engine) {
  std::vector<int> list{0, 1, 2, 3};
  list.resize(directions);
  Options options;
  options.parameter_scales = std::vector<double>{0.2, 5e-5, 10.0, 0.018};
  options.parameter_scales.resize(directions);
  const Problem problem = two_beam::makeProblem(list);
  Integrator integrator(problem, two_beam::makeTimes(), options, engine);
  const Batch batch(directions);
  for (auto _ : state) {
    benchmark::DoNotOptimize(integrate(integrator, batch.samples));
  }
  setCounters(state, problem, integrator.getStatistics(), engine);
  state.counters["error"] = calcLargestError(batch.outputs, getReference(directions).outputs);
  if (directions > 0) {
    state.counters["derivative_error"] =
        calcLargestError(batch.derivatives, getReference(directions).derivatives);
  }
}

#ifdef __AVX512F__
/// The equations of motion in registers instead of a program: what no interpreter can beat.
void runClosedForm(const program::PlacedRun* run, const program::PlacedRun* end,
                   const program::PlacedInstruction*, double* slots) {
  using namespace program;
  if (end - run < 5) {
    return;  // the hoisted segments
  }
  const auto get = [slots](int slot) { return load<Packet8>(slots + 8 * slot); };
  const double m2 = 0.13, y_com = 0.034, z_com = 0.022, inertia = 1.3e-4, g = 9.81;
  const double m11 = 3.3 + m2, m22 = inertia + m2 * (y_com * y_com + z_com * z_com);
  const SineCosine<Packet8> sc = calcSineCosine(get(2));
  const Packet8 a = y_com * sc.sine + z_com * sc.cosine, b = y_com * sc.cosine - z_com * sc.sine;
  const Packet8 m12 = -m2 * a, pulse = get(9);
  const Packet8 r1 = two_beam::kForce * pulse + m2 * b * get(4) * get(4) - get(5) * get(3) - get(7) * get(1);
  const Packet8 r2 = two_beam::kMoment * pulse - get(6) * get(4) - get(8) * get(2) - m2 * g * b;
  const Packet8 inverse = 1.0 / (m11 * m22 - m12 * m12);
  const Problem& problem = getTwoBeamProblem();
  store(slots + 8 * problem.derivative.outputs[2], (m22 * r1 - m12 * r2) * inverse);
  store(slots + 8 * problem.derivative.outputs[3], (m11 * r2 - m12 * r1) * inverse);
}

const program::Engine kClosedForm{8, program::kEngine8.isSupported, runClosedForm};
const StepEngine kClosedFormSteps{
    kClosedForm,    kSteps8.times,       kSteps8.plan,           kSteps8.prepareStage,
    kSteps8.finish, kSteps8.interpolate, kSteps8.interpolateAll, kSteps8.accept};
#endif

/// Six masses that swing for 5 s, 100 outputs of each angle.
void runChain(benchmark::State& state, int directions, const StepEngine& engine) {
  constexpr int kMasses = 6;
  std::vector<int> list{0, 1, 2};
  list.resize(directions);
  const Problem problem = pendulum::makeProblem(kMasses, list);
  Integrator integrator(problem, two_beam::makeTimes(), {}, engine);
  constexpr int kChainValues = (kMasses + 1) * 100;
  std::vector<double> outputs(kChainValues * kSamples), derivatives(kChainValues * kSamples * directions);
  std::vector<Sample> samples(kSamples);
  for (int j = 0; j < kSamples; ++j) {
    samples[j].parameters = std::vector<double>{1.0, 0.5 + 0.001 * j, 9.81};
    samples[j].initial.assign(problem.getRowCount(), 0.0);
    std::fill_n(samples[j].initial.begin(), 2 * kMasses, 0.3);
    samples[j].phases = {{0.0, {}}};
    samples[j].end = two_beam::kDuration;
    samples[j].outputs = &outputs[kChainValues * j];
    samples[j].derivatives = derivatives.data() + kChainValues * j * directions;
  }
  for (auto _ : state) {
    benchmark::DoNotOptimize(integrate(integrator, samples));
  }
  setCounters(state, problem, integrator.getStatistics(), engine);
}

void registerAll() {
#ifdef __AVX512F__
  benchmark::RegisterBenchmark("TwoBeam/closed_form", [](benchmark::State& state) {
    runTwoBeam(state, 0, kClosedFormSteps);
  })->Unit(benchmark::kMillisecond);
#endif
  for (const StepEngine* engine : getEngines()) {
    const std::string lanes =
        "/lanes:" + std::to_string(engine->program.lanes) + (engine == &kSteps8Of4 ? "_of_4" : "");
    const auto add = [&lanes, engine](const std::string& name, auto run, int directions) {
      benchmark::RegisterBenchmark((name + lanes).c_str(), [=](benchmark::State& state) {
        run(state, directions, *engine);
      })->Unit(benchmark::kMillisecond);
    };
    add("TwoBeam", runTwoBeam, 0);
    add("TwoBeamWithDerivatives", runTwoBeam, 4);
    add("Chain", runChain, 0);
    add("ChainWithDerivatives", runChain, 3);
  }
}

const bool registered = (registerAll(), true);

}  // namespace
}  // namespace twinmap::lanes
