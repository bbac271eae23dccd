#include "framework/experiment/feature_spec.hpp"

#include <algorithm>

namespace twinmap {
namespace {

template <class Kind>
std::vector<Name> getOutputsOf(const Kind& kind) {
  return kind.outputs;
}
std::vector<Name> getOutputsOf(const ExtremaFeatureSpec& extrema) {
  return {extrema.output};
}
std::vector<Name> getOutputsOf(const ModesFeatureSpec&) {
  return {};
}

template <class Kind>
const WindowSpec& getWindowOf(const Kind& kind) {
  return kind.window;
}
WindowSpec getWindowOf(const SamplesFeatureSpec& samples) {
  return {samples.start, samples.interval, samples.count};
}
WindowSpec getWindowOf(const ModesFeatureSpec&) {
  return {};
}

}  // namespace

std::vector<Name> getOutputs(const FeatureSpec& feature) {
  return std::visit([](const auto& kind) { return getOutputsOf(kind); }, feature);
}

WindowSpec getWindow(const FeatureSpec& feature) {
  return std::visit([](const auto& kind) -> WindowSpec { return getWindowOf(kind); }, feature);
}

int countModes(const std::vector<FeatureSpec>& features) {
  int count = 0;
  for (const FeatureSpec& feature : features) {
    const auto* modes = std::get_if<ModesFeatureSpec>(&feature);
    count = std::max(count, modes != nullptr ? modes->count : 0);
  }
  return count;
}

std::vector<Name> collectOutputs(const std::vector<FeatureSpec>& features) {
  std::vector<Name> all;
  for (const FeatureSpec& feature : features) {
    const std::vector<Name> outputs = getOutputs(feature);
    all.insert(all.end(), outputs.begin(), outputs.end());
  }
  return all;
}

void appendSampleTimes(const WindowSpec& window, std::vector<double>& times) {
  for (int i = 0; i < window.count; ++i) {
    times.push_back(calcSampleTime(window, i));
  }
}

void sortUnique(std::vector<double>& times) {
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
}

std::vector<double> collectTimesOf(const std::string& output, const std::vector<FeatureSpec>& features) {
  std::vector<double> times;
  for (const FeatureSpec& feature : features) {
    for (const Name& name : getOutputs(feature)) {
      if (name.text == output) {
        appendSampleTimes(getWindow(feature), times);
      }
    }
  }
  sortUnique(times);
  return times;
}

}  // namespace twinmap
