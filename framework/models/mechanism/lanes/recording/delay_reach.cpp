#include "framework/models/mechanism/lanes/recording/delay_reach.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "framework/experiment/model/parameter_box.hpp"
#include "framework/simulation/model_numbers.hpp"

namespace twinmap {

Bounds calcReach(const ModelSpec& model, const Expression& expression, const std::string& owner) {
  const std::vector<ParameterSpec> sampled = collectSampled(model);
  const Eigen::VectorXd center = calcBoxCenter(sampled), lower = calcLowerBounds(sampled),
                        upper = lower + calcWidths(sampled);
  ModelNumbers numbers(model);
  Bounds reach{0.0, 0.0, {}};
  const auto look = [&](const Eigen::VectorXd& point) {
    numbers.update(point);
    const double value = numbers.calc(expression, {owner, "delay", "s"});
    reach.lower = std::min(reach.lower, value);
    reach.upper = std::max(reach.upper, value);
  };
  look(lower);
  look(upper);
  for (Eigen::Index i = 0; i < center.size(); ++i) {
    for (const double end : {lower[i], upper[i]}) {
      Eigen::VectorXd point = center;
      point[i] = end;
      look(point);
    }
  }
  return reach;
}

void requireWithinSimulation(const ModelSpec& model, const Eigen::VectorXd& times) {
  const double duration = model.simulation.duration;
  for (const OutputSpec& output : model.outputs) {
    if (times.size() == 0 || !output.sensor || output.sensor->delay.text.empty()) {
      continue;
    }
    const Expression& delay = output.sensor->delay;
    const double least = calcReach(model, delay, "output '" + output.name.text + "'").lower;
    const double last = times[times.size() - 1] - least;
    if (last > duration * (1.0 + 1e-12)) {
      throw ExperimentError(
          delay.where, delay.text,
          fmt::format("may be {:.6g} s, so that the sample at {:.6g} s shows what is behind the simulation's "
                      "end: set simulation.duration to {:.6g} s",
                      least, times[times.size() - 1], last));
    }
  }
}

}  // namespace twinmap
