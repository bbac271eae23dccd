#include "framework/models/mechanism/lanes/recording/recorded_controller.hpp"

#include <algorithm>
#include <cmath>

#include "framework/models/mechanism/lanes/recording/delay_reach.hpp"
#include "framework/models/mechanism/varying_expressions.hpp"
#include "kernels/lanes/program/differentiate.hpp"

namespace twinmap {
namespace {

using program::Symbol;

const std::string kDifference = "difference(";

/// The value at the place that `input` (a clock's) says, of `count` that begin with `values`; `other` where
/// the clock does not strike.
Symbol choose(const Symbol& input, const Symbol* values, int count, Symbol other) {
  for (int slot = 0; slot < count; ++slot) {
    other = select(equal(input, Symbol(1.0 + slot)), values[slot], other);
  }
  return other;
}

void replaceAt(const Symbol& input, const Symbol& value, Symbol* values, int count) {
  for (int slot = 0; slot < count; ++slot) {
    values[slot] = select(equal(input, Symbol(1.0 + slot)), value, values[slot]);
  }
}

std::size_t findOutput(const ModelSpec& model, const std::string& name) {
  const auto found = std::find_if(model.outputs.begin(), model.outputs.end(),
                                  [&](const OutputSpec& output) { return output.name.text == name; });
  return static_cast<std::size_t>(found - model.outputs.begin());
}

}  // namespace

ControllerRecorder::ControllerRecorder(const SampledModel& sampled, const ControllerSpec& spec,
                                       int first_hidden, RecordedSampling& recorded)
    : sampled_(sampled), spec_(spec), recorded_(recorded), first_hidden_(first_hidden) {
  slots_ = countSlots();
  read_input_ = addClock(Symbol(0.0), 1.0);
  const Symbol delay = sampled.numbers.calc(spec.delay);
  if (!delay.isLiteral(0.0)) {
    write_input_ = addClock(delay, 1.0);
    pending_ = reserve(slots_ * static_cast<int>(spec.writes.size()));
  }
  for (const ReadingSpec& reading : spec.reads) {
    addTakes(reading);
  }
  for (const DiscreteStateSpec& state : spec.states) {
    findDifferences(state.next);
  }
  for (const ControllerOutputSpec& output : spec.writes) {
    findDifferences(output.value);
  }
  for (int i = 0; i < hidden_count_; ++i) {
    hidden_.push_back(sampled.recorder.state(first_hidden + i));
  }
}

/// At least as many as are under way at a time: one more than the longest delay has periods.
int ControllerRecorder::countSlots() const {
  constexpr double kMost = 1000.0;
  const double periods = std::floor(calcLongestDelay() / spec_.sample_time) + 2.0;
  if (periods > kMost) {
    throw ExperimentError(spec_.name.where, spec_.name.text,
                          "has delays, its own or its sensors', of more than 1000 sample times; take a "
                          "longer sample_time");
  }
  return static_cast<int>(periods);
}

double ControllerRecorder::calcLongestDelay() const {
  const ModelSpec& model = sampled_.model;
  const std::string owner = "controller '" + spec_.name.text + "'";
  double longest = calcReach(model, spec_.delay, owner).upper;
  for (const ReadingSpec& reading : spec_.reads) {
    const std::size_t output = findOutput(model, reading.source.text);
    if (output < model.outputs.size() && looksBack(output)) {
      const SensorSpec& sensor = *model.outputs[output].sensor;
      const double delay = sensor.delay.text.empty() ? 0.0 : calcReach(model, sensor.delay, owner).upper;
      const double window = sensor.average.text.empty() ? 0.0 : calcReach(model, sensor.average, owner).upper;
      longest = std::max(longest, delay + window);
    }
  }
  return longest;
}

bool ControllerRecorder::looksBack(std::size_t output) const {
  const std::optional<SensorSpec>& sensor = sampled_.model.outputs[output].sensor;
  return sensor && (!sensor->delay.text.empty() || !sensor->average.text.empty());
}

int ControllerRecorder::addClock(const Symbol& delay, double sign) {
  int place = -1;
  if (!delay.isLiteral(0.0)) {
    place = static_cast<int>(recorded_.delays.size());
    recorded_.delays.push_back(delay);
  }
  const int input = recorded_.input_count++;
  recorded_.clocks.push_back({spec_.sample_time, place, sign, input, slots_});
  return input;
}

int ControllerRecorder::reserve(int count) {
  const int place = first_hidden_ + hidden_count_;
  hidden_count_ += count;
  return place;
}

void ControllerRecorder::addTakes(const ReadingSpec& reading) {
  const std::size_t output = findOutput(sampled_.model, reading.source.text);
  if (output == sampled_.model.outputs.size() || !looksBack(output)) {
    return;
  }
  const SensorSpec& sensor = *sampled_.model.outputs[output].sensor;
  const Symbol delay = sampled_.numbers.calc(sensor.delay, 0.0);
  if (!delay.isLiteral(0.0)) {
    addTake(output, false, delay);
  }
  if (!sensor.average.text.empty()) {
    addTake(output, true, delay + sampled_.numbers.calc(sensor.average));
  }
}

void ControllerRecorder::addTake(std::size_t output, bool before, const Symbol& delay) {
  const auto same = [&](const Take& take) { return take.output == output && take.before == before; };
  if (std::none_of(takes_.begin(), takes_.end(), same)) {
    const int input = addClock(delay, -1.0);
    takes_.push_back({output, before, input, reserve(slots_)});
  }
}

void ControllerRecorder::findDifferences(const Expression& expression) {
  for (const std::string& name : getUsedNames(expression)) {
    const auto same = [&](const Difference& other) { return other.name == name; };
    if (name.rfind(kDifference, 0) == 0 && std::none_of(differences_.begin(), differences_.end(), same)) {
      const std::string inside = name.substr(kDifference.size(), name.size() - kDifference.size() - 1);
      differences_.push_back({name, {inside, expression.where}, reserve(1)});
    }
  }
}

int ControllerRecorder::findState(const Name& name) const {
  const std::vector<std::string>& names = sampled_.names.getStateNames();
  return static_cast<int>(std::find(names.begin(), names.end(), name.text) - names.begin());
}

void ControllerRecorder::write(Symbols& first_order) {
  if (write_input_ < 0) {
    return;
  }
  int pending = pending_;
  for (const ControllerOutputSpec& output : spec_.writes) {
    Symbol& held = first_order[findState(output.name)];
    held = choose(getInput(write_input_), &updHidden(pending), slots_, held);
    pending += slots_;
  }
}

ControllerRecorder::Symbols ControllerRecorder::run(const Symbol& is_start,
                                                    const std::vector<Symbols>& sensors,
                                                    Symbols& first_order) {
  const Symbols quantities = sampled_.calcQuantities(first_order);
  take(is_start, sensors, quantities);
  compute(nameReadings(sensors, quantities, first_order), first_order);
  return hidden_;
}

RecordedSensor ControllerRecorder::recordOutput(std::size_t output, const Symbols& states,
                                                const Symbol& quantity) const {
  const std::optional<SensorSpec>& sensor = sampled_.model.outputs[output].sensor;
  return recordSensor(sensor ? *sensor : SensorSpec{}, sampled_.numbers, quantity, states);
}

/// What would have been taken before the start is what is settled there.
void ControllerRecorder::take(const Symbol& is_start, const std::vector<Symbols>& sensors,
                              const Symbols& quantities) {
  for (const Take& one : takes_) {
    const RecordedSensor sensor = recordOutput(one.output, sensors[one.output], quantities[one.output]);
    const Symbol part = one.before ? sensor.before : sensor.now;
    Symbol* const memory = &updHidden(one.memory);
    for (int slot = 0; slot < slots_; ++slot) {
      memory[slot] = select(is_start, part, memory[slot]);
    }
    replaceAt(getInput(one.clock_input), part, memory, slots_);
  }
}

Symbol ControllerRecorder::recall(std::size_t output, bool before) const {
  for (const Take& one : takes_) {
    if (one.output == output && one.before == before) {
      return choose(getInput(read_input_), &hidden_[one.memory - first_hidden_], slots_, Symbol(0.0));
    }
  }
  return {};
}

Symbol ControllerRecorder::read(const ReadingSpec& reading, const std::vector<Symbols>& sensors,
                                const Symbols& quantities) {
  const std::size_t output = findOutput(sampled_.model, reading.source.text);
  if (output == quantities.size()) {
    return sampled_.coordinates[sampled_.names.findCoordinate(reading.source)];
  }
  const std::optional<SensorSpec>& spec = sampled_.model.outputs[output].sensor;
  if (!spec) {
    return quantities[output];
  }
  const RecordedSensor sensor = recordOutput(output, sensors[output], quantities[output]);
  const Symbol now = sensor.delay.isLiteral(0.0) ? sensor.now : recall(output, false);
  return quantise(*spec, clip(*spec, spec->average.text.empty() ? now : now - recall(output, true)));
}

Symbol ControllerRecorder::quantise(const SensorSpec& sensor, const Symbol& reading) {
  if (!sensor.quantum) {
    return reading;
  }
  const Symbol rounded = rint(reading / Symbol(*sensor.quantum)) * Symbol(*sensor.quantum);
  if (!rounded.isLiteral()) {
    recorded_.passed.push_back({rounded, reading});
  }
  return rounded;
}

/// What the controller's expressions may use.
NamedValues<Symbol> ControllerRecorder::nameReadings(const std::vector<Symbols>& sensors,
                                                     const Symbols& quantities, const Symbols& first_order) {
  NamedValues<Symbol> scope = sampled_.numbers;
  const std::vector<SignalSpec>& signals = sampled_.model.excitation;
  const std::vector<std::string> rate_names = nameSignalRates(signals, 2);
  const std::vector<program::Seed> in_time{{sampled_.recorder.time(), 1.0}};
  const Symbols rates = program::calcTangents(sampled_.signals, in_time);
  const Symbols second_rates = program::calcTangents(rates, in_time);
  for (std::size_t i = 0; i < signals.size(); ++i) {
    scope.set(signals[i].name.text, sampled_.signals[i]);
    scope.set(rate_names[i], rates[i]);
    scope.set(rate_names[signals.size() + i], second_rates[i]);
  }
  scope.set("t", sampled_.recorder.time());
  for (const ControllerSpec& controller : sampled_.model.system.controllers) {
    for (const DiscreteStateSpec& state : controller.states) {
      scope.set(state.name.text, first_order[findState(state.name)]);
    }
    for (const ControllerOutputSpec& output : controller.writes) {
      scope.set(output.name.text, first_order[findState(output.name)]);
    }
  }
  for (const ReadingSpec& reading : spec_.reads) {
    scope.set(reading.name.text, read(reading, sensors, quantities));
  }
  const Symbol is_first = lessOrEqual(sampled_.recorder.time(), Symbol(0.0));
  const Symbol reads = less(Symbol(0.0), getInput(read_input_));
  for (const Difference& difference : differences_) {
    const Symbol value = scope.calc(difference.of);
    Symbol& memory = updHidden(difference.memory);
    const Symbol change = (value - memory) / Symbol(spec_.sample_time);
    scope.set(difference.name, select(is_first, Symbol(0.0), change));
    memory = select(reads, value, memory);
  }
  return scope;
}

void ControllerRecorder::compute(const NamedValues<Symbol>& scope, Symbols& first_order) {
  const Symbol input = getInput(read_input_), reads = less(Symbol(0.0), input);
  int pending = pending_;
  for (const ControllerOutputSpec& output : spec_.writes) {
    const Symbol value = scope.calc(output.value);
    if (write_input_ < 0) {
      Symbol& held = first_order[findState(output.name)];
      held = select(reads, value, held);
    } else {
      replaceAt(input, value, &updHidden(pending), slots_);
      pending += slots_;
    }
  }
  for (const DiscreteStateSpec& state : spec_.states) {
    Symbol& held = first_order[findState(state.name)];
    held = select(reads, scope.calc(state.next), held);
  }
}

}  // namespace twinmap
