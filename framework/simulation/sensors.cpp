#include "framework/simulation/sensors.hpp"

namespace twinmap {
namespace {

using Eigen::Index;

std::string getOwner(const OutputSpec& output) {
  return "output '" + output.name.text + "'";
}

/// Calls use(output, its first row, its rows).
template <class Use>
void forEachOutput(const ModelSpec& model, Index rows, const Use& use) {
  const auto count = static_cast<Index>(model.outputs.size());
  for (Index i = 0; i < count; ++i) {
    use(model.outputs[static_cast<std::size_t>(i)], i * (rows / count), rows / count);
  }
}

}  // namespace

void applyGains(const ModelSpec& model, ModelNumbers& numbers, Eigen::Ref<Eigen::MatrixXd> derivatives) {
  forEachOutput(model, derivatives.rows(), [&](const OutputSpec& output, Index first, Index rows) {
    if (!output.gain.text.empty()) {
      derivatives.middleRows(first, rows) *= numbers.calc(output.gain, {getOwner(output), "gain", ""});
    }
  });
}

void applySensors(const ModelSpec& model, ModelNumbers& numbers, Eigen::Ref<Eigen::VectorXd> response) {
  applyGains(model, numbers, response);
  forEachOutput(model, response.size(), [&](const OutputSpec& output, Index first, Index rows) {
    if (!output.offset.text.empty()) {
      response.segment(first, rows).array() +=
          numbers.calc(output.offset, {getOwner(output), "offset", output.unit.c_str()});
    }
  });
}

}  // namespace twinmap
