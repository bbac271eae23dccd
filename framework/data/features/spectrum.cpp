#include "framework/data/features/spectrum.hpp"

#include "framework/data/features/complex_lines.hpp"
#include "framework/data/features/layout_rows.hpp"

namespace twinmap {

std::shared_ptr<const FeatureBlock> makeSpectrumBlock(const SpectrumFeatureSpec& spec,
                                                      const ResponseLayout& layout) {
  std::vector<ComplexLine> lines;
  for (const Name& name : spec.outputs) {
    const Eigen::Index output = findOutput(layout, name.text);
    for (const Frequency& frequency : spec.frequencies) {
      lines.push_back({name.text, layout.output_units[output], static_cast<int>(output), frequency.hertz,
                       findRows(layout, output, spec.window),
                       calcLineWeights(spec.window, frequency, spec.window_function)});
    }
  }
  return makeComplexBlock(lines, spec.parts, layout.getRowCount());
}

}  // namespace twinmap
