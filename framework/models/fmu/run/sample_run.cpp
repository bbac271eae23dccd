#include "framework/models/fmu/run/sample_run.hpp"

#include <cmath>

namespace twinmap::fmi {
namespace {

BoundVariables select(const BoundVariables& all, bool continuous) {
  BoundVariables selected;
  for (std::size_t i = 0; i < all.slots.size(); ++i) {
    if ((all.slots[i].variable->variability == Variability::kContinuous) == continuous) {
      selected.slots.push_back(all.slots[i]);
      selected.units.push_back(all.units[i]);
      selected.sources.push_back(all.sources[i]);
    }
  }
  return selected;
}

}  // namespace

DrivenInputs::DrivenInputs(const BoundVariables& inputs, int signals)
    : continuous_(select(inputs, true)), discrete_(select(inputs, false)), values_(signals) {}

void DrivenInputs::setAll(Instance& instance, const Excitation& excitation, double t) {
  setDiscrete(instance, excitation, t);
  setContinuous(instance, excitation, t);
}

void DrivenInputs::setDiscrete(Instance& instance, const Excitation& excitation, double t) {
  if (!discrete_.isEmpty()) {
    excitation.calcValues(t, values_);
    discrete_.set(instance, values_.data());
    discrete_values_ = values_;
  }
}

bool DrivenInputs::hasDiscreteChanged(const Excitation& excitation, double t) {
  if (discrete_.isEmpty()) {
    return false;
  }
  excitation.calcValues(t, values_);
  return !discrete_.isSame(values_, discrete_values_);
}

void DrivenInputs::setContinuous(Instance& instance, const Excitation& excitation, double t) {
  if (hasContinuous()) {
    excitation.calcValues(t, values_);
    continuous_.set(instance, values_.data());
  }
}

void SampleRun::record(int index) {
  const std::vector<double>& values = outputs.get(instance);
  const Eigen::Index times = setting.times.size();
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i])) {
      throw FmuFailure(describeAt("output '" + setting.outputs.slots[i].variable->name + "' is not finite",
                                  setting.times[index]));
    }
    response[static_cast<Eigen::Index>(i) * times + index] = values[i];
  }
}

EventInfo iterateEvents(Instance& instance, double t) {
  constexpr int kMaxIterations = 10000;  // of discrete states that depend on one another
  EventInfo last, all;
  int count = 0;
  do {
    last = instance.updateDiscreteStates();
    all.terminate = all.terminate || last.terminate;
    all.states_changed = all.states_changed || last.states_changed;
    if (++count > kMaxIterations) {
      throw FmuFailure(describeAt("the event iteration does not end", t));
    }
  } while (last.again && !all.terminate);
  all.next_time = last.next_time;
  return all;
}

void SampleRun::initialise() {
  instance.enterInitialization(0.0, setting.duration, setting.integration.relative_tolerance);
  excitation.mute();
  excitation.beginPhase(0.0);
  inputs.setAll(instance, excitation, 0.0);
  instance.exitInitialization();
}

}  // namespace twinmap::fmi
