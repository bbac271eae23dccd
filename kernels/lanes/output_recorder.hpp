#pragma once

#include <vector>

#include "kernels/lanes/problem.hpp"
#include "kernels/lanes/program/interpreter.hpp"
#include "kernels/lanes/sample.hpp"

namespace twinmap::lanes {

/// The states of each lane's sample at the output times, and the outputs computed from them: when a sample is
/// done, the lanes of one interpreter take as many of its times together.
class OutputRecorder {
 public:
  OutputRecorder(const Problem& problem, const std::vector<double>& times, const program::Engine& engine);

  /// Row r of lane `lane` is states[r * lanes + lane].
  void keep(int lane, int time, int phase, const double* states);
  /// Writes the outputs of a lane whose states are all kept.
  void write(int lane, const Sample& sample);

 private:
  void setSample(const Sample& sample);
  void setTimes(int lane, int first, const Sample& sample);

  const std::vector<double> times_;
  program::InputCounts counts_;
  int rows_, lanes_, value_count_, derivative_count_;
  program::Interpreter interpreter_;
  std::vector<double> states_;  ///< lane by lane, row by row, all times of a row together
  std::vector<int> phases_;     ///< lane by lane
};

}  // namespace twinmap::lanes
