#include "framework/models/mechanism/single_program.hpp"

#include <algorithm>

namespace twinmap {

using Eigen::VectorXd;
using program::Interpreter;

namespace {

/// Gives all lanes the same values.
template <typename Values>
void setRows(Interpreter& interpreter, double* (Interpreter::*row)(int), const Values& values) {
  for (int i = 0; i < static_cast<int>(values.size()); ++i) {
    std::fill_n((interpreter.*row)(i), interpreter.getLanes(), values[i]);
  }
}

}  // namespace

SingleProgram::SingleProgram(const program::Program& program)
    : interpreter_(program), output_count_(static_cast<int>(program.outputs.size())) {
  setRows(interpreter_, &Interpreter::updParameter, VectorXd::Zero(program.counts.parameters));
  setRows(interpreter_, &Interpreter::updState, VectorXd::Zero(program.counts.states));
  setRows(interpreter_, &Interpreter::updPhaseInput, VectorXd::Zero(program.counts.phase_inputs));
}

VectorXd SingleProgram::calc(const ProgramInputs& inputs) {
  setRows(interpreter_, &Interpreter::updParameter, inputs.parameters);
  setRows(interpreter_, &Interpreter::updState, inputs.states);
  setRows(interpreter_, &Interpreter::updPhaseInput, inputs.phase_inputs);
  std::fill_n(interpreter_.updTime(), interpreter_.getLanes(), inputs.time);
  interpreter_.calcParameters();
  interpreter_.calcPhase();
  interpreter_.calcOutputs();
  VectorXd outputs(output_count_);
  for (int i = 0; i < output_count_; ++i) {
    outputs[i] = *interpreter_.getOutput(i);
  }
  return outputs;
}

void SingleProgram::enterPhase(const std::vector<double>& parameters,
                               const std::vector<double>& phase_inputs) {
  setRows(interpreter_, &Interpreter::updParameter, parameters);
  setRows(interpreter_, &Interpreter::updPhaseInput, phase_inputs);
  interpreter_.calcParameters();
  interpreter_.calcPhase();
}

void SingleProgram::calcAt(double time, const std::vector<double>& states) {
  setRows(interpreter_, &Interpreter::updState, states);
  std::fill_n(interpreter_.updTime(), interpreter_.getLanes(), time);
  interpreter_.calcOutputs();
}

}  // namespace twinmap
