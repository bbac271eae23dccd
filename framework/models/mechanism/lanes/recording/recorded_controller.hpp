#pragma once

#include <string>
#include <vector>

#include "framework/models/mechanism/lanes/recording/sampled_model.hpp"

namespace twinmap {

/// One controller, written down: what it adds to the jumps of a model. Its clocks, delays, phase inputs and
/// quantised readings go to what is recorded.
class ControllerRecorder {
 public:
  using Symbols = std::vector<program::Symbol>;

  /// `first_hidden`: the place of its first hidden state among all states. `sampled` and `recorded` must
  /// outlive this.
  ControllerRecorder(const SampledModel& sampled, const ControllerSpec& spec, int first_hidden,
                     RecordedSampling& recorded);

  int getHiddenCount() const { return hidden_count_; }

  /// Shows what is due. `first_order`: all states of first order; changed.
  void write(Symbols& first_order);

  /// Takes, reads and computes. `sensors`: the states of each output's sensor, which are settled at the start
  /// (`is_start`). Returns its hidden states.
  Symbols run(const program::Symbol& is_start, const std::vector<Symbols>& sensors, Symbols& first_order);

 private:
  /// A reading whose sensor looks into the past: what it has taken stands in `slots_` hidden states.
  struct Take {
    std::size_t output;
    bool before;  ///< RecordedSensor::before, else now
    int clock_input, memory;
  };
  struct Difference {
    std::string name;
    Expression of;
    int memory;
  };

  void findDifferences(const Expression& expression);
  void addTakes(const ReadingSpec& reading);
  void addTake(std::size_t output, bool before, const program::Symbol& delay);
  int addClock(const program::Symbol& delay, double sign);
  int reserve(int count);
  int countSlots() const;
  double calcLongestDelay() const;
  bool looksBack(std::size_t output) const;

  void take(const program::Symbol& is_start, const std::vector<Symbols>& sensors, const Symbols& quantities);
  program::Symbol read(const ReadingSpec& reading, const std::vector<Symbols>& sensors,
                       const Symbols& quantities);
  program::Symbol recall(std::size_t output, bool before) const;
  program::Symbol quantise(const SensorSpec& sensor, const program::Symbol& reading);
  NamedValues<program::Symbol> nameReadings(const std::vector<Symbols>& sensors, const Symbols& quantities,
                                            const Symbols& first_order);
  void compute(const NamedValues<program::Symbol>& scope, Symbols& first_order);

  program::Symbol& updHidden(int place) { return hidden_[place - first_hidden_]; }
  int findState(const Name& name) const;
  program::Symbol getInput(int input) const { return sampled_.recorder.phaseInput(input); }
  RecordedSensor recordOutput(std::size_t output, const Symbols& states,
                              const program::Symbol& quantity) const;

  const SampledModel& sampled_;
  const ControllerSpec& spec_;
  RecordedSampling& recorded_;
  const int first_hidden_;
  int hidden_count_ = 0, slots_ = 0;
  int read_input_ = -1, write_input_ = -1;  ///< -1: it writes where it reads
  int pending_ = 0;                         ///< place of what it has computed, output by output
  std::vector<Take> takes_;
  std::vector<Difference> differences_;
  Symbols hidden_;
};

}  // namespace twinmap
