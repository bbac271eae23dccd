#include "framework/inference/shown_start.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "framework/experiment/check/known_names.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/models/start_states.hpp"

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

/// The output that is the coordinate itself.
int findOutput(const ModelSpec& model, const std::string& coordinate) {
  for (std::size_t o = 0; o < model.outputs.size(); ++o) {
    const OutputSpec& output = model.outputs[o];
    if (output.coordinate && output.coordinate->text == coordinate && output.gain.text.empty() &&
        output.offset.text.empty()) {
      return static_cast<int>(o);
    }
  }
  return -1;
}

}  // namespace

VectorXd readShownStart(const ModelSpec& model, const std::vector<FeatureInfo>& infos,
                        const VectorXd& features) {
  const std::vector<ParameterSpec> unknown = collectUnknown(model);
  const std::vector<std::string> names = collectNames(unknown);
  VectorXd shown = VectorXd::Constant(static_cast<Index>(unknown.size()), std::nan(""));
  bool is_any = false;
  for (const StartState& state : listStartStates(model)) {
    const auto found = std::find(names.begin(), names.end(), state.initial.text);
    if (found == names.end() || state.kind == StartState::Kind::kState) {
      continue;
    }
    if (const auto beginning = readBeginning(infos, features, findOutput(model, state.name))) {
      const auto j = found - names.begin();
      const Bounds& bounds = unknown[static_cast<std::size_t>(j)].bounds;
      const double value = state.kind == StartState::Kind::kSpeed ? beginning->slope : beginning->value;
      shown[j] = std::clamp(value, bounds.lower, bounds.upper);
      is_any = true;
    }
  }
  return is_any ? shown : VectorXd();
}

}  // namespace twinmap
