#include "framework/inference/start_readings.hpp"

#include <algorithm>

namespace twinmap {
namespace {

StartReading makeReading(const OutputSpec& output, std::size_t number, ModelNumbers& numbers) {
  StartReading reading{static_cast<Eigen::Index>(number)};
  const auto read = [&](const Expression& expression, double& value) {
    if (!expression.text.empty()) {
      value = numbers.calc(expression, {"output", "sensor", ""});
      reading.varies = reading.varies || numbers.varies(expression);
    }
  };
  read(output.gain, reading.gain);
  read(output.offset, reading.offset);
  return reading;
}

}  // namespace

std::vector<StartReading> listReadings(const ModelSpec& model, const StartState& state,
                                       ModelNumbers& numbers) {
  const bool is_speed = state.kind == StartState::Kind::kSpeed;
  std::vector<StartReading> readings;
  for (std::size_t o = 0; o < model.outputs.size() && state.kind != StartState::Kind::kState; ++o) {
    const OutputSpec& output = model.outputs[o];
    const bool of_speed = output.speed && output.speed->text == state.name;
    const bool of_coordinate = output.coordinate && output.coordinate->text == state.name;
    if (of_coordinate || (of_speed && is_speed)) {
      readings.push_back(makeReading(output, o, numbers));
      readings.back().of_slope = of_coordinate && is_speed;
    }
  }
  std::stable_partition(readings.begin(), readings.end(), [](const auto& one) { return !one.of_slope; });
  return readings;
}

}  // namespace twinmap
