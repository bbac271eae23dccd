#include "framework/simulation/excitation/calc_input_signals.hpp"

#include "framework/experiment/model/parameter_box.hpp"
#include "framework/simulation/excitation/excitation.hpp"
#include "framework/simulation/model_numbers.hpp"

namespace twinmap {

InputSignals calcInputSignals(const ModelSpec& model, const Eigen::VectorXd& times) {
  ModelNumbers numbers(model);
  numbers.update(calcBoxCenter(collectSampled(model)));
  Excitation excitation(model.excitation);
  excitation.update(numbers);
  const std::vector<double> events = excitation.calcEventTimes(model.simulation.duration);

  InputSignals inputs;
  for (const SignalSpec& signal : model.excitation) {
    inputs.names.push_back(signal.name.text);
    inputs.units.push_back(signal.unit);
  }
  inputs.values.resize(times.size(), excitation.getSignalCount());
  std::vector<double> values(excitation.getSignalCount());
  excitation.beginPhase(0.0);
  std::size_t next = 0;
  for (Eigen::Index i = 0; i < times.size(); ++i) {
    for (; next < events.size() && events[next] <= times[i]; ++next) {
      excitation.beginPhase(events[next]);
    }
    excitation.calcValues(times[i], values);
    inputs.values.row(i) = Eigen::Map<const Eigen::RowVectorXd>(values.data(), inputs.values.cols());
  }
  return inputs;
}

}  // namespace twinmap
