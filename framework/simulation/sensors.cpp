#include "framework/simulation/sensors.hpp"

namespace twinmap {

void applySensors(const ModelSpec& model, ModelNumbers& numbers, Eigen::Ref<Eigen::VectorXd> response) {
  for (std::size_t i = 0; i < model.outputs.size(); ++i) {
    const Eigen::Index times = response.size() / static_cast<Eigen::Index>(model.outputs.size());
    const OutputSpec& output = model.outputs[i];
    auto rows = response.segment(static_cast<Eigen::Index>(i) * times, times).array();
    const std::string owner = "output '" + output.name.text + "'";
    if (!output.gain.text.empty()) {
      rows *= numbers.updNumbers().calc(output.gain, {owner, "gain", ""});
    }
    if (!output.offset.text.empty()) {
      rows += numbers.updNumbers().calc(output.offset, {owner, "offset", output.unit.c_str()});
    }
  }
}

}  // namespace twinmap
