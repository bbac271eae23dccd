#include "kernels/lanes/problem.hpp"

#include "kernels/lanes/program/differentiate.hpp"
#include "kernels/lanes/program/recorder.hpp"

namespace twinmap::lanes {
namespace {

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

void append(const std::vector<Symbol>& more, std::vector<Symbol>& symbols) {
  symbols.insert(symbols.end(), more.begin(), more.end());
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
  for (int j = 0; j < static_cast<int>(directions.size()); ++j) {
    const std::vector<Seed> seeds = makeSeeds(recorder, equations, directions, j);
    append(calcTangents(equations.derivatives, seeds), rows);
    append(calcTangents(equations.outputs, seeds), outputs);
    append(calcTangents(equations.projection, seeds), projection);
  }
  append(equations.pivots, rows);
  program::InputCounts counts = equations.counts;
  counts.states = problem.getRowCount();
  problem.derivative = compile(recorder, rows, counts);
  problem.output = compile(recorder, outputs, counts);
  problem.projection = compile(recorder, projection, counts);
  return problem;
}

}  // namespace twinmap::lanes
