#include "framework/data/features/sampled_outputs.hpp"

#include <cstdio>

#include "framework/data/features/layout_rows.hpp"

namespace twinmap {

std::string makeFeatureName(const std::string& output, double time) {
  char text[32];
  std::snprintf(text, sizeof(text), "(%.6g s)", time);
  return output + text;
}

std::shared_ptr<const FeatureBlock> makeSamplesBlock(const SamplesFeatureSpec& spec,
                                                     const ResponseLayout& layout) {
  std::vector<FeatureInfo> infos;
  FeatureMatrix matrix(static_cast<Eigen::Index>(spec.outputs.size()) * spec.count, layout.getRowCount());
  for (const Name& name : spec.outputs) {
    const Eigen::Index output = findOutput(layout, name.text);
    for (int i = 0; i < spec.count; ++i) {
      const double time = calcSampleTime(spec, i);
      matrix.insert(static_cast<Eigen::Index>(infos.size()), layout.getRow(output, findTime(layout, time))) =
          1.0;
      infos.push_back(
          {makeFeatureName(name.text, time), layout.output_units[output], static_cast<int>(output), time});
      infos.back().is_at_start = time == 0.0;
    }
  }
  return std::make_shared<LinearBlock>(std::move(infos), matrix);
}

}  // namespace twinmap
