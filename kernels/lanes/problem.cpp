#include "kernels/lanes/problem.hpp"

#include <algorithm>

#include "kernels/lanes/program/differentiate.hpp"
#include "kernels/lanes/program/recorder.hpp"

namespace twinmap::lanes {
namespace {

using program::Differentiator;
using program::Recorder;
using program::Seed;
using program::Symbol;

/// The direction in which states change by their sensitivities as parameter `directions[j]` changes by 1.
std::vector<Seed> makeSeeds(Recorder& recorder, const Equations& equations,
                            const std::vector<int>& directions, int j) {
  const int states = equations.counts.states;
  std::vector<Seed> seeds{{recorder.parameter(directions[j]), 1.0}};
  for (int i = 0; i < states; ++i) {
    seeds.push_back({recorder.state(i), recorder.state(states * (1 + j) + i)});
  }
  return seeds;
}

/// The same for what was there a delay ago: that time moves against the delay, unless it is the begin.
std::vector<Seed> makeDelayedSeeds(Recorder& recorder, const Equations& equations,
                                   const std::vector<int>& directions, int j, Symbol delay) {
  std::vector<Seed> seeds = makeSeeds(recorder, equations, directions, j);
  const Symbol change = program::calcTangents({delay}, {{recorder.parameter(directions[j]), 1.0}})[0];
  if (change.isLiteral(0.0)) {
    return seeds;
  }
  const Symbol moves = select(less(Symbol(0.0), recorder.time()), -change, Symbol(0.0));
  for (int i = 0; i < equations.counts.states; ++i) {
    seeds[1 + i].tangent += equations.derivatives[i] * moves;
  }
  seeds.push_back({recorder.time(), moves});
  return seeds;
}

void append(const std::vector<Symbol>& more, std::vector<Symbol>& symbols) {
  symbols.insert(symbols.end(), more.begin(), more.end());
}

/// The derivatives of the outputs in direction j.
std::vector<Symbol> calcOutputTangents(Recorder& recorder, const Equations& equations,
                                       const std::vector<int>& directions, int j, Differentiator& outputs) {
  std::vector<Symbol> tangents = outputs.calcTangents(makeSeeds(recorder, equations, directions, j));
  for (std::size_t i = 0; i < equations.output_delays.size(); ++i) {
    if (const int delay = equations.output_delays[i]; delay >= 0) {
      tangents[i] = calcTangents({equations.outputs[i]}, makeDelayedSeeds(recorder, equations, directions, j,
                                                                          equations.delays[delay]))[0];
    }
  }
  return tangents;
}

/// How values change with the states and with each direction's parameter, written down once: the change along
/// a direction is then (df/dy) s + df/dp.
class Linearization {
 public:
  Linearization(Recorder& recorder, const std::vector<Symbol>& values, int states)
      : recorder_(recorder), values_(values), states_(states) {
    for (int i = 0; i < states; ++i) {
      by_state_.push_back(values_.calcTangents({{recorder.state(i), 1.0}}));
    }
  }

  std::vector<Symbol> calcChanges(int parameter, int j) {
    std::vector<Symbol> changes = values_.calcTangents({{recorder_.parameter(parameter), 1.0}});
    for (int i = 0; i < states_; ++i) {
      const Symbol sensitivity = recorder_.state(states_ * (1 + j) + i);
      for (std::size_t row = 0; row < changes.size(); ++row) {
        changes[row] += by_state_[static_cast<std::size_t>(i)][row] * sensitivity;
      }
    }
    return changes;
  }

 private:
  Recorder& recorder_;
  Differentiator values_;
  const int states_;
  std::vector<std::vector<Symbol>> by_state_;  ///< derivatives of the values, by state
};

/// With fewer directions than this for each state, one forward pass a direction takes fewer operations than
/// the derivatives by all states and their products.
constexpr std::size_t kFewDirections = 16, kDirectionsPerState = 2;

void appendSensitivities(Recorder& recorder, const Equations& equations, const std::vector<int>& directions,
                         std::vector<Symbol>& rows, std::vector<Symbol>& outputs) {
  const auto states = static_cast<std::size_t>(equations.counts.states);
  const bool is_delayed = !equations.delays.empty();  // an output of another time has derivatives of its own
  Differentiator outputs_alone(equations.outputs);
  if (directions.size() > std::max(kFewDirections, kDirectionsPerState * states)) {
    Linearization motion(recorder, equations.derivatives, equations.counts.states);
    Linearization seen(recorder, equations.outputs, equations.counts.states);
    for (int j = 0; j < static_cast<int>(directions.size()); ++j) {
      append(motion.calcChanges(directions[j], j), rows);
      append(is_delayed ? calcOutputTangents(recorder, equations, directions, j, outputs_alone)
                        : seen.calcChanges(directions[j], j),
             outputs);
    }
    return;
  }
  Differentiator rates(equations.derivatives);
  for (int j = 0; j < static_cast<int>(directions.size()); ++j) {
    append(rates.calcTangents(makeSeeds(recorder, equations, directions, j)), rows);
    append(calcOutputTangents(recorder, equations, directions, j, outputs_alone), outputs);
  }
}

/// `jumps`: those of the equations, or their transitions.
program::Program compileJump(Recorder& recorder, const Equations& equations, const std::vector<Symbol>& jumps,
                             const std::vector<int>& directions, program::InputCounts counts) {
  std::vector<Symbol> rows = jumps;
  if (rows.empty()) {
    return {};
  }
  Differentiator behind(jumps);
  for (int j = 0; j < static_cast<int>(directions.size()); ++j) {
    std::vector<Seed> seeds = makeSeeds(recorder, equations, directions, j);
    seeds.push_back({recorder.time(), recorder.phaseInput(counts.phase_inputs + j)});
    for (const Passed& passed : equations.passed) {
      seeds.push_back({passed.value, calcTangents({passed.as}, seeds)[0]});
    }
    append(behind.calcTangents(seeds), rows);
  }
  counts.phase_inputs += static_cast<int>(directions.size());
  return compile(recorder, rows, counts);
}

void compileEvents(Recorder& recorder, const Equations& equations, const std::vector<int>& directions,
                   const program::InputCounts& counts, Problem& problem) {
  problem.guard_count = static_cast<int>(equations.guards.size());
  problem.event_input = equations.event_input;
  std::vector<Seed> flow{{recorder.time(), 1.0}};
  for (int i = 0; i < equations.counts.states; ++i) {
    flow.push_back({recorder.state(i), equations.derivatives[i]});
  }
  Differentiator guards(equations.guards);
  std::vector<Symbol> changes = guards.calcTangents(flow);
  for (int j = 0; j < static_cast<int>(directions.size()); ++j) {
    append(guards.calcTangents(makeSeeds(recorder, equations, directions, j)), changes);
  }
  std::vector<Symbol> looked_at = equations.guards;
  append(equations.dips, looked_at);
  problem.dip_count = static_cast<int>(equations.dips.size());
  problem.guard = compile(recorder, looked_at, equations.counts);
  problem.guard_change = compile(recorder, changes, counts);
  problem.transition = compileJump(recorder, equations, equations.transitions, directions, counts);
}

}  // namespace

Problem makeProblem(Recorder& recorder, const Equations& equations, const std::vector<int>& directions) {
  Problem problem;
  problem.counts = equations.counts;
  problem.directions = directions;
  problem.pivot_count = static_cast<int>(equations.pivots.size());
  problem.output_count = static_cast<int>(equations.outputs.size());
  std::vector<Symbol> rows = equations.derivatives, outputs = equations.outputs,
                      projection = equations.projection;
  appendSensitivities(recorder, equations, directions, rows, outputs);
  Differentiator projected(equations.projection);
  for (int j = 0; j < static_cast<int>(directions.size()); ++j) {
    append(projected.calcTangents(makeSeeds(recorder, equations, directions, j)), projection);
  }
  append(equations.pivots, rows);
  program::InputCounts counts = equations.counts;
  counts.states = problem.getRowCount();
  problem.derivative = compile(recorder, rows, counts);
  problem.output = compile(recorder, outputs, counts);
  problem.output_delays = equations.output_delays;
  problem.delay_count = static_cast<int>(equations.delays.size());
  problem.jump = compileJump(recorder, equations, equations.jumps, directions, counts);
  if (!equations.guards.empty()) {
    compileEvents(recorder, equations, directions, counts, problem);
  }
  problem.projection = compile(recorder, projection, counts);
  return problem;
}

}  // namespace twinmap::lanes
