#pragma once

#include <vector>

#include "kernels/lanes/program/recorder.hpp"

namespace twinmap::program::testing {

struct Inputs {
  double time = 0.0;
  std::vector<double> states, parameters, phase_inputs;
};

/// The values of symbols by walking through the recorded graph, node by node.
inline std::vector<double> walk(Recorder& recorder, const std::vector<Symbol>& symbols,
                                const Inputs& inputs) {
  std::vector<int> wanted;
  for (const Symbol& symbol : symbols) {
    wanted.push_back(recorder.findNode(symbol));
  }
  std::vector<double> values;
  for (const Node& node : recorder.getNodes()) {
    const auto get = [&values](int operand) { return operand < 0 ? 0.0 : values[operand]; };
    switch (node.operation) {
      case Operation::kLiteral:
        values.push_back(node.literal);
        break;
      case Operation::kTime:
        values.push_back(inputs.time);
        break;
      case Operation::kState:
        values.push_back(inputs.states[node.a]);
        break;
      case Operation::kParameter:
        values.push_back(inputs.parameters[node.a]);
        break;
      case Operation::kPhaseInput:
        values.push_back(inputs.phase_inputs[node.a]);
        break;
      default:
        values.push_back(evaluate(node.operation, get(node.a), get(node.b), get(node.c)));
    }
  }
  std::vector<double> result;
  for (const int node : wanted) {
    result.push_back(values[node]);
  }
  return result;
}

}  // namespace twinmap::program::testing
