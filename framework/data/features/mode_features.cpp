#include "framework/data/features/mode_features.hpp"

#include <stdexcept>

namespace twinmap {

std::shared_ptr<const FeatureBlock> makeModesBlock(const ModesFeatureSpec& spec,
                                                   const ResponseLayout& layout) {
  if (spec.count > layout.modes) {
    throw std::invalid_argument("feature of more modes than the responses have");
  }
  std::vector<FeatureInfo> infos;
  std::vector<Eigen::Index> rows;
  for (int i = 0; i < spec.count && spec.frequencies; ++i) {
    infos.push_back({"natural frequency " + std::to_string(i + 1), "Hz", -1, 0.0});
    rows.push_back(layout.getFrequencyRow(i));
  }
  for (int i = 0; i < spec.count && spec.damping_ratios; ++i) {
    infos.push_back({"damping ratio " + std::to_string(i + 1), "", -1, 0.0});
    rows.push_back(layout.getDampingRow(i));
  }
  FeatureMatrix matrix(static_cast<Eigen::Index>(rows.size()), layout.getRowCount());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    matrix.insert(static_cast<Eigen::Index>(i), rows[i]) = 1.0;
  }
  return std::make_shared<LinearBlock>(std::move(infos), matrix);
}

}  // namespace twinmap
