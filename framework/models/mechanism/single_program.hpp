#pragma once

#include <Eigen/Core>
#include <vector>

#include "kernels/lanes/program/interpreter.hpp"

namespace twinmap {

/// What a program reads; what it does not read may be empty.
struct ProgramInputs {
  Eigen::VectorXd parameters, states = {}, phase_inputs = {};
  double time = 0.0;
};

/// A program carried out for one sample at a time. Not thread safe. Cost: that of a packet.
class SingleProgram {
 public:
  explicit SingleProgram(const program::Program& program);

  /// The outputs. What is missing of the inputs is as it was before, 0 at first.
  Eigen::VectorXd calc(const ProgramInputs& inputs);

  /// Parameters and phase inputs for the calls of calcAt() that follow.
  void enterPhase(const std::vector<double>& parameters, const std::vector<double>& phase_inputs);
  /// Evaluates the outputs at a time and states, as many as the program counts.
  void calcAt(double time, const std::vector<double>& states);
  double getOutput(int index) const { return *interpreter_.getOutput(index); }
  int getOutputCount() const { return output_count_; }

 private:
  program::Interpreter interpreter_;
  int output_count_;
};

}  // namespace twinmap
