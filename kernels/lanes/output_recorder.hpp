#pragma once

#include <vector>

#include "kernels/lanes/problem.hpp"
#include "kernels/lanes/program/interpreter.hpp"
#include "kernels/lanes/sample.hpp"

namespace twinmap::lanes {

/// The states of each lane's sample at the output times, and the outputs computed from them: when a sample is
/// done, the lanes of one interpreter take as many of its times together. Outputs that are states are copied.
class OutputRecorder {
 public:
  OutputRecorder(const Problem& problem, const std::vector<double>& times, const program::Engine& engine);

  /// A time at which a lane's states are kept, and the place that they take: that of the i-th output time is
  /// i, before delay d that plus (1 + d) times their number.
  struct KeptTime {
    double time;
    int place;
  };
  /// In their order, of a sample; outputs without delays have the same for all.
  std::vector<KeptTime> listKeptTimes(const Sample& sample) const;

  /// States at one time or several: row r at the i-th time is values[r * stride + i].
  struct States {
    const double* values;
    int stride;
  };
  void keep(int lane, const KeptTime* kept, int count, int phase, const States& states);
  /// Writes the outputs of a lane whose states are all kept.
  void write(int lane, const Sample& sample);

 private:
  void copyStates(int lane, const Sample& sample);
  void setSample(const Sample& sample);
  void setTimes(int lane, int delay, int first, const Sample& sample);
  double calcTime(const Sample& sample, int delay, int time) const;
  void writeDelayed(int lane, int delay, const Sample& sample);
  bool has(int output, int delay) const {
    return output_delays_.empty() ? delay < 0 : output_delays_[output] == delay;
  }

  const std::vector<double> times_;
  const std::vector<int> output_delays_;
  const int delay_count_;
  program::InputCounts counts_;
  int rows_, lanes_, value_count_, derivative_count_;
  std::vector<int> copied_;  ///< by value and derivative: the state that it is, or -1
  bool all_copied_;
  program::Interpreter interpreter_;
  std::vector<double> states_;  ///< lane by lane, row by row, all places of a row together
  std::vector<int> phases_;     ///< lane by lane

  double* getTarget(const Sample& sample, int output) const {
    const std::size_t count = times_.size();
    return output < value_count_ ? sample.outputs + output * count
                                 : sample.derivatives + (output - value_count_) * count;
  }
};

}  // namespace twinmap::lanes
