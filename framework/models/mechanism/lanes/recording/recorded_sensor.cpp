#include "framework/models/mechanism/lanes/recording/recorded_sensor.hpp"

#include <boost/math/constants/constants.hpp>
#include <cmath>

namespace twinmap {
namespace {

using program::Symbol;
using Symbols = RecordedSensor::Symbols;

constexpr double kPi = boost::math::constants::pi<double>();

/// Leads a quantity through one part of a sensor after the other.
class SensorRecorder {
 public:
  SensorRecorder(const Symbol& quantity, const Symbols& states)
      : quantity_(quantity), signal_(quantity), states_(states) {}

  /// Settled, every state that passes the quantity on has its value.
  void addLag(const Symbol& rate) {
    const Symbol y = states_[next_++];
    add(rate * (signal_ - y), quantity_);
    signal_ = y;
  }

  /// y'' = frequency^2 (signal - y) - damping frequency y', as y and z = y + y' / frequency: both are of the
  /// signal's size, so that errors count by what a reading shows of them. Those of y' itself count by how
  /// slow the signal is: at a current between the samples of a controller they asked for twice the steps.
  void addSecondOrder(const Symbol& frequency, double damping) {
    const Symbol y = states_[next_++], z = states_[next_++];
    add(frequency * (z - y), quantity_);
    add(frequency * (signal_ - y + Symbol(1.0 - damping) * (z - y)), quantity_);
    signal_ = y;
  }

  void addFilter(int order, const Symbol& cutoff) {
    const Symbol frequency = Symbol(2.0 * kPi) * cutoff;
    for (int k = 1; k <= order / 2; ++k) {
      addSecondOrder(frequency, 2.0 * std::sin((2 * k - 1) * kPi / (2 * order)));
    }
    if (order % 2 == 1) {
      addLag(frequency);
    }
  }

  void addAverage(const Symbol& window) {
    const Symbol start = states_[next_++], integral = states_[next_++];
    add(0.0, quantity_);
    add((signal_ - start) / window, 0.0);
    signal_ = start + integral;
    sensor_.before = integral;
    sensor_.window = window;
  }

  RecordedSensor finish(const Symbol& delay) {
    sensor_.now = signal_;
    sensor_.delay = delay;
    return std::move(sensor_);
  }

 private:
  void add(const Symbol& rate, const Symbol& settled) {
    sensor_.rates.push_back(rate);
    sensor_.settled.push_back(settled);
  }

  const Symbol quantity_;
  Symbol signal_;
  const Symbols& states_;
  std::size_t next_ = 0;
  RecordedSensor sensor_;
};

}  // namespace

int countSensorStates(const SensorSpec& sensor) {
  return (sensor.lag.text.empty() ? 0 : 1) + (sensor.filter ? sensor.filter->order : 0) +
         (sensor.average.text.empty() ? 0 : 2);
}

RecordedSensor recordSensor(const SensorSpec& sensor, const NamedValues<Symbol>& names,
                            const Symbol& quantity, const Symbols& states) {
  SensorRecorder recorder(quantity, states);
  if (!sensor.lag.text.empty()) {
    recorder.addLag(Symbol(1.0) / names.calc(sensor.lag));
  }
  if (sensor.filter) {
    recorder.addFilter(sensor.filter->order, names.calc(sensor.filter->cutoff));
  }
  if (!sensor.average.text.empty()) {
    recorder.addAverage(names.calc(sensor.average));
  }
  return recorder.finish(names.calc(sensor.delay, 0.0));
}

Symbol clip(const SensorSpec& sensor, const Symbol& reading) {
  return sensor.range ? max(min(reading, Symbol(sensor.range->upper)), Symbol(sensor.range->lower)) : reading;
}

}  // namespace twinmap
