#include "framework/models/mechanism/lanes/recording/recorded_sampling.hpp"

#include "framework/models/mechanism/lanes/recording/recorded_controller.hpp"

namespace twinmap {
namespace {

using program::Symbol;
using Symbols = RecordedSampling::Symbols;

/// Sensors' states first, output by output.
class SamplingRecorder {
 public:
  explicit SamplingRecorder(const SampledModel& sampled)
      : sampled_(sampled), first_hidden_(static_cast<int>(sampled.states.size())) {
    recorded_.input_count = sampled.input_count;
  }

  RecordedSampling record() {
    const std::vector<ControllerSpec>& controllers = sampled_.model.system.controllers;
    recordSensors();
    recorded_.output_delay_count = static_cast<int>(recorded_.delays.size());
    if (count_ > 0 || !controllers.empty()) {
      recorded_.start_input = recorded_.input_count++;
      recordJumps();
    }
    return std::move(recorded_);
  }

 private:
  Symbols getHidden(int first, int count) {
    Symbols states;
    for (int i = 0; i < count; ++i) {
      states.push_back(sampled_.recorder.state(first_hidden_ + first + i));
    }
    return states;
  }

  void recordSensors() {
    const std::vector<OutputSpec>& outputs = sampled_.model.outputs;
    const Symbols quantities = sampled_.calcQuantities(getFirstOrder());
    recorded_.outputs = quantities;
    recorded_.subtracted.assign(outputs.size(), -1);
    std::vector<int> delays(outputs.size(), -1);
    bool any = false;
    for (std::size_t i = 0; i < outputs.size(); ++i) {
      if (!outputs[i].sensor) {
        continue;
      }
      const int own = countSensorStates(*outputs[i].sensor);
      const RecordedSensor sensor =
          recordSensor(*outputs[i].sensor, sampled_.numbers, quantities[i], getHidden(count_, own));
      count_ += own;
      recorded_.hidden_rates.insert(recorded_.hidden_rates.end(), sensor.rates.begin(), sensor.rates.end());
      recorded_.outputs[i] = sensor.now;
      delays[i] = addDelay(sensor.delay);
      if (!sensor.window.isLiteral(0.0)) {
        recorded_.subtracted[i] = static_cast<int>(recorded_.outputs.size());
        recorded_.outputs.push_back(sensor.before);
        delays.push_back(addDelay(sensor.delay + sensor.window));
      }
      any = any || delays[i] >= 0 || recorded_.subtracted[i] >= 0;
    }
    recorded_.output_delays = any ? delays : std::vector<int>{};
  }

  int addDelay(const Symbol& delay) {
    if (delay.isLiteral(0.0)) {
      return -1;
    }
    recorded_.delays.push_back(delay);
    return static_cast<int>(recorded_.delays.size()) - 1;
  }

  Symbols getFirstOrder() const {
    return {sampled_.states.begin() + sampled_.getFirstOrderPlace(), sampled_.states.end()};
  }

  void recordJumps() {
    const Symbol is_start = sampled_.recorder.phaseInput(recorded_.start_input);
    Symbols first_order = getFirstOrder();
    std::vector<Symbols> settled = settle(is_start, first_order);
    std::vector<ControllerRecorder> controllers;
    for (const ControllerSpec& controller : sampled_.model.system.controllers) {
      controllers.emplace_back(sampled_, controller, first_hidden_ + count_, recorded_);
      count_ += controllers.back().getHiddenCount();
    }
    recorded_.hidden_rates.resize(count_, Symbol(0.0));
    for (ControllerRecorder& controller : controllers) {
      controller.write(first_order);
    }
    Symbols hidden;
    for (const Symbols& states : settled) {
      hidden.insert(hidden.end(), states.begin(), states.end());
    }
    for (ControllerRecorder& controller : controllers) {
      const Symbols changed = controller.run(is_start, settled, first_order);
      hidden.insert(hidden.end(), changed.begin(), changed.end());
    }
    recorded_.jumps.assign(sampled_.states.begin(), sampled_.states.begin() + sampled_.getFirstOrderPlace());
    recorded_.jumps.insert(recorded_.jumps.end(), first_order.begin(), first_order.end());
    recorded_.jumps.insert(recorded_.jumps.end(), hidden.begin(), hidden.end());
  }

  /// The states of each output's sensor.
  std::vector<Symbols> settle(const Symbol& is_start, const Symbols& first_order) {
    const Symbols quantities = sampled_.calcQuantities(first_order);
    std::vector<Symbols> settled;
    int first = 0;
    for (std::size_t i = 0; i < quantities.size(); ++i) {
      const std::optional<SensorSpec>& sensor = sampled_.model.outputs[i].sensor;
      Symbols states = getHidden(first, sensor ? countSensorStates(*sensor) : 0);
      first += static_cast<int>(states.size());
      if (!states.empty()) {
        const RecordedSensor at_start = recordSensor(*sensor, sampled_.numbers, quantities[i], states);
        for (std::size_t k = 0; k < states.size(); ++k) {
          states[k] = select(is_start, at_start.settled[k], states[k]);
        }
      }
      settled.push_back(std::move(states));
    }
    return settled;
  }

  const SampledModel& sampled_;
  const int first_hidden_;
  int count_ = 0;  ///< hidden states so far
  RecordedSampling recorded_;
};

}  // namespace

RecordedSampling recordSampling(const SampledModel& sampled) {
  return SamplingRecorder(sampled).record();
}

}  // namespace twinmap
