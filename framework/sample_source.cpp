#include "framework/sample_source.hpp"

#include "framework/features/layout_rows.hpp"

namespace twinmap {
namespace {

std::vector<Eigen::Index> findRows(const ResponseLayout& from, const ResponseLayout& to) {
  std::vector<Eigen::Index> rows;
  for (Eigen::Index output = 0; output < to.getOutputCount(); ++output) {
    for (const double time : to.times) {
      rows.push_back(from.getRow(output, findTime(from, time)));
    }
  }
  for (int mode = 0; mode < to.modes; ++mode) {
    rows.push_back(from.getFrequencyRow(mode));
  }
  for (int mode = 0; mode < to.modes; ++mode) {
    rows.push_back(from.getDampingRow(mode));
  }
  return rows;
}

}  // namespace

Trajectories selectRows(Trajectories trajectories, const ResponseLayout& layout) {
  if (trajectories.layout.getRowCount() != layout.getRowCount()) {
    trajectories.responses =
        Eigen::MatrixXd(trajectories.responses(findRows(trajectories.layout, layout), Eigen::all));
  }
  trajectories.layout = layout;
  return trajectories;
}

}  // namespace twinmap
