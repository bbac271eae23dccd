#include "framework/inference/shown_start.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "framework/experiment/check/known_names.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/inference/start_readings.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

/// Value and slope at 0 s of a parabola.
struct Beginning {
  double value = 0.0, slope = 0.0;
};

/// Through three points, by Newton's divided differences.
Beginning extrapolate(const std::vector<double>& t, const std::vector<double>& y) {
  const double first = (y[1] - y[0]) / (t[1] - t[0]), second = (y[2] - y[1]) / (t[2] - t[1]);
  const double bend = (second - first) / (t[2] - t[0]);
  return {y[0] - first * t[0] + bend * t[0] * t[1], first - bend * (t[0] + t[1])};
}

std::optional<Beginning> readBeginning(const std::vector<FeatureInfo>& infos, const VectorXd& features,
                                       int output) {
  constexpr std::size_t kPoints = 3;
  std::vector<double> t, y;
  for (std::size_t i = 0; i < infos.size() && t.size() < kPoints; ++i) {
    const double value = features[static_cast<Index>(i)];
    if (infos[i].isSample() && infos[i].output == output && std::isfinite(value) &&
        (t.empty() || infos[i].time > t.back())) {
      t.push_back(infos[i].time);
      y.push_back(value);
    }
  }
  return t.size() == kPoints ? std::optional<Beginning>(extrapolate(t, y)) : std::nullopt;
}

/// By the first output that shows it and whose sensor is known.
std::optional<double> readState(const std::vector<StartReading>& readings,
                                const std::vector<FeatureInfo>& infos, const VectorXd& features) {
  for (const StartReading& reading : readings) {
    const auto beginning =
        reading.varies ? std::nullopt : readBeginning(infos, features, static_cast<int>(reading.output));
    if (beginning) {
      return reading.read(beginning->value, beginning->slope);
    }
  }
  return std::nullopt;
}

}  // namespace

VectorXd readShownStart(const ModelSpec& model, const std::vector<FeatureInfo>& infos,
                        const VectorXd& features) {
  const std::vector<ParameterSpec> unknown = collectUnknown(model);
  const std::vector<std::string> names = collectNames(unknown);
  const auto find = [&](const StartState& state) {
    return static_cast<std::size_t>(std::find(names.begin(), names.end(), state.initial.text) -
                                    names.begin());
  };
  std::vector<StartState> states = listStartStates(model);
  states.erase(std::remove_if(states.begin(), states.end(),
                              [&](const StartState& state) { return find(state) == names.size(); }),
               states.end());
  if (states.empty()) {
    return {};
  }
  VectorXd shown = VectorXd::Constant(static_cast<Index>(unknown.size()), std::nan(""));
  ModelNumbers numbers(model);
  numbers.update(calcBoxCenter(collectSampled(model)));
  for (const StartState& state : states) {
    if (const auto value = readState(listReadings(model, state, numbers), infos, features)) {
      const Bounds& bounds = unknown[find(state)].bounds;
      shown[static_cast<Index>(find(state))] = std::clamp(*value, bounds.lower, bounds.upper);
    }
  }
  return shown.array().isNaN().all() ? VectorXd() : shown;
}

}  // namespace twinmap
