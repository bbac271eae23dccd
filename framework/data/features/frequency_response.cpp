#include "framework/data/features/frequency_response.hpp"

#include <algorithm>
#include <stdexcept>

#include "framework/base/text/number_text.hpp"
#include "framework/data/features/complex_lines.hpp"
#include "framework/data/features/layout_rows.hpp"

namespace twinmap {
namespace {

using Eigen::Index;

struct SampledSignal {
  std::string unit;
  Eigen::VectorXd values;  ///< at the samples of the window
};

SampledSignal sampleSignal(const FrequencyResponseFeatureSpec& spec, const ResponseLayout& layout,
                           const InputSignals& inputs) {
  const auto found = std::find(inputs.names.begin(), inputs.names.end(), spec.excitation.text);
  if (found == inputs.names.end() || inputs.values.rows() != layout.times.size()) {
    throw std::invalid_argument("frequency response to an unknown excitation '" + spec.excitation.text + "'");
  }
  const Index signal = found - inputs.names.begin();
  SampledSignal sampled{inputs.units[signal], Eigen::VectorXd(spec.window.count)};
  for (int i = 0; i < spec.window.count; ++i) {
    sampled.values[i] = inputs.values(findTime(layout, calcSampleTime(spec.window, i)), signal);
  }
  return sampled;
}

std::string makeRatioUnit(const std::string& unit, const std::string& over) {
  if (over.empty()) {
    return unit;
  }
  return unit + "/" + (over.find_first_of(" */") == std::string::npos ? over : "(" + over + ")");
}

}  // namespace

std::shared_ptr<const FeatureBlock> makeFrequencyResponseBlock(const FrequencyResponseFeatureSpec& spec,
                                                               const ResponseLayout& layout,
                                                               const InputSignals& inputs) {
  constexpr double kMinEnergy = 1e-6;
  const SampledSignal signal = sampleSignal(spec, layout, inputs);
  std::vector<ComplexLine> lines;
  for (const Name& name : spec.outputs) {
    const Index output = findOutput(layout, name.text);
    for (const Frequency& frequency : spec.frequencies) {
      const Eigen::VectorXcd weights = calcLineWeights(spec.window, frequency, WindowFunction::kRectangular);
      const std::complex<double> excitation = (weights.array() * signal.values.array()).sum();
      if (!(std::abs(excitation) > kMinEnergy * signal.values.lpNorm<Eigen::Infinity>())) {
        throw ExperimentError(frequency.where, toText(frequency.hertz),
                              "is a frequency at which excitation '" + spec.excitation.text +
                                  "' has no energy within the window");
      }
      lines.push_back({name.text + "/" + spec.excitation.text,
                       makeRatioUnit(layout.output_units[output], signal.unit), static_cast<int>(output),
                       frequency.hertz, findRows(layout, output, spec.window), weights / excitation,
                       spec.excitation.text});
    }
  }
  return makeComplexBlock(lines, spec.parts, layout.getRowCount());
}

}  // namespace twinmap
