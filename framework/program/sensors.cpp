#include "framework/program/sensors.hpp"

namespace twinmap {

void applySensors(const ModelSpec& model, const ResponseLayout& layout, ModelNumbers& numbers,
                  Eigen::Ref<Eigen::VectorXd> response) {
  for (std::size_t i = 0; i < model.outputs.size(); ++i) {
    const OutputSpec& output = model.outputs[i];
    auto rows = response.segment(layout.getRow(static_cast<Eigen::Index>(i), 0), layout.times.size()).array();
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
