#include "bench/simulation/lane_profile.hpp"

#include <algorithm>

#include "bench/simulation/measure.hpp"
#include "framework/models/mechanism/lanes/lane_start.hpp"
#include "framework/models/mechanism/lanes/recording/recorded_model.hpp"
#include "framework/models/mechanism/simbody_model.hpp"
#include "kernels/lanes/integrator.hpp"
#include "kernels/lanes/program/real.hpp"

namespace twinmap::bench {
namespace {

using program::Operation;

double countOperations(Operation operation) {
  switch (operation) {
    case Operation::kMultiplyAdd:
    case Operation::kMultiplySubtract:
    case Operation::kNegativeMultiplyAdd:
      return 2.0;
    case Operation::kSinCos:
      return 40.0;
    default:
      return 1.0;
  }
}

/// All but the time.
ProgramCost countCost(const program::Program& program, int lanes) {
  const program::Segment& segment = program.evaluation;
  ProgramCost cost;
  cost.memory = 8.0 * program.slot_count * lanes;
  cost.instructions = static_cast<int>(segment.instructions.size());
  cost.dispatches = static_cast<int>(segment.runs.size());
  for (const program::Run& run : segment.runs) {
    const int targets = run.operation == Operation::kSinCos ? 2 : 1;
    cost.operations += run.count * countOperations(run.operation);
    cost.bytes += run.count * 8.0 * (program::countOperands(run.operation) + targets);
  }
  return cost;
}

/// ns an evaluation and lane; the median of rounds of some ms.
double measureEvaluation(program::Interpreter& interpreter, int instructions) {
  interpreter.calcParameters();
  interpreter.calcPhase();
  const int count = 2000000 / (10 + instructions);
  const auto evaluate = [&interpreter, count] {
    for (int i = 0; i < count; ++i) {
      interpreter.calcOutputs();
    }
  };
  constexpr int kRounds = 9;
  return 1e3 * measureInAlternation({{count * interpreter.getLanes(), evaluate}}, kRounds, readThreadTime)[0];
}

ProgramCost measureProgram(program::Recorder& recorder, const std::vector<program::Symbol>& outputs,
                           int states, int samples) {
  const program::Program program = compile(recorder, outputs, {states, 0, 0});
  program::Interpreter interpreter(program, lanes::chooseEngine(samples).program);
  for (int i = 0; i < states; ++i) {
    std::fill_n(interpreter.updState(i), interpreter.getLanes(), 0.1 * (i + 1));
  }
  ProgramCost cost = countCost(program, interpreter.getLanes());
  cost.time_ns = measureEvaluation(interpreter, cost.instructions);
  return cost;
}

/// At the begin of the samples.
ProgramCost measureDerivative(const lanes::Problem& problem, const lanes::StepEngine& engine,
                              const std::vector<lanes::Sample>& samples) {
  program::Interpreter interpreter(problem.derivative, engine.program);
  for (int lane = 0; lane < interpreter.getLanes(); ++lane) {
    const lanes::Sample& sample = samples[lane % samples.size()];
    for (int i = 0; i < problem.counts.states; ++i) {
      interpreter.updState(i)[lane] = sample.initial[i];
    }
    for (int i = 0; i < problem.counts.parameters; ++i) {
      interpreter.updParameter(i)[lane] = sample.parameters[i];
    }
    for (int i = 0; i < problem.counts.phase_inputs; ++i) {
      interpreter.updPhaseInput(i)[lane] = sample.phases[0].inputs[i];
    }
  }
  ProgramCost cost = countCost(problem.derivative, interpreter.getLanes());
  cost.time_ns = measureEvaluation(interpreter, cost.instructions);
  return cost;
}

lanes::Options makeOptions(const SimulationSpec& simulation) {
  lanes::Options options;
  options.relative_tolerance = simulation.relative_tolerance;
  options.absolute_tolerance = simulation.absolute_tolerance;
  options.max_steps = simulation.max_steps;
  return options;
}

LaneProfile makeProfile(const lanes::Statistics& statistics, int lanes, double samples) {
  constexpr int kEvaluationsAStep = 6;
  LaneProfile profile;
  profile.lanes = lanes;
  profile.steps = static_cast<double>(statistics.steps) / samples;
  profile.rejected_share = static_cast<double>(statistics.rejected) / static_cast<double>(statistics.steps);
  profile.active_lanes =
      static_cast<double>(statistics.active_lanes) / static_cast<double>(statistics.rounds);
  profile.evaluations = static_cast<double>(kEvaluationsAStep * statistics.rounds * lanes) / samples;
  return profile;
}

}  // namespace

LaneProfile measureLanes(const ModelSpec& model, const Eigen::VectorXd& times,
                         const Eigen::MatrixXd& points) {
  const Eigen::VectorXd box_center = makeSimbodyModel(model)->solveBoxCenter();
  const LaneModel lane_model = compileModel(recordModel(model, SystemNames(model.system)));
  LaneStart start(model, lane_model, box_center, times);
  const int count = static_cast<int>(points.cols());
  Eigen::MatrixXd outputs(static_cast<Eigen::Index>(model.outputs.size()) * times.size(), count);
  std::vector<lanes::Sample> samples(count);
  for (int i = 0; i < count; ++i) {
    start.fill(points.col(i), samples[i]);
    samples[i].outputs = outputs.col(i).data();
  }
  const lanes::StepEngine& engine = lanes::chooseEngine(count);
  lanes::Integrator integrator(lane_model.problem, {times.begin(), times.end()},
                               makeOptions(model.simulation), engine);
  integrate(integrator, samples);
  LaneProfile profile = makeProfile(integrator.getStatistics(), engine.program.lanes, count);
  profile.derivative = measureDerivative(lane_model.problem, engine, samples);
  return profile;
}

ProgramCost measureMultiplyAdds(int samples) {
  constexpr int kStates = 8;
  program::Recorder recorder;
  std::vector<program::Symbol> outputs;
  for (int i = 0; i < kStates; ++i) {
    for (int j = 0; j < i; ++j) {
      for (int k = 0; k < 4; ++k) {
        outputs.push_back(recorder.state(i) * recorder.state(j) + recorder.state(k));
      }
    }
  }
  return measureProgram(recorder, outputs, kStates, samples);
}

ProgramCost measureSines(int samples) {
  constexpr int kStates = 16;
  program::Recorder recorder;
  std::vector<program::Symbol> outputs;
  for (int i = 0; i < kStates; ++i) {
    outputs.push_back(sin(recorder.state(i)));
    outputs.push_back(cos(recorder.state(i)));
  }
  return measureProgram(recorder, outputs, kStates, samples);
}

}  // namespace twinmap::bench
