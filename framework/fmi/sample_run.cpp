#include "framework/fmi/sample_run.hpp"

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
  if (!discrete_.isEmpty()) {
    excitation.calcValues(t, values_);
    discrete_.set(instance, values_.data());
  }
  setContinuous(instance, excitation, t);
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

void SampleRun::initialise() {
  instance.enterInitialization(0.0, setting.duration, setting.integration.relative_tolerance);
  excitation.mute();
  excitation.beginPhase(0.0);
  inputs.setAll(instance, excitation, 0.0);
  instance.exitInitialization();
}

}  // namespace twinmap::fmi
