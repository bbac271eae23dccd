#include "framework/study/samples/sample_source.hpp"

#include "framework/data/features/layout_rows.hpp"

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

Eigen::MatrixXd selectRows(Eigen::MatrixXd responses, const ResponseLayout& from, const ResponseLayout& to) {
  return from.getRowCount() == to.getRowCount() ? std::move(responses)
                                                : Eigen::MatrixXd(responses(findRows(from, to), Eigen::all));
}

Trajectories selectRows(Trajectories trajectories, const ResponseLayout& layout) {
  trajectories.responses = selectRows(std::move(trajectories.responses), trajectories.layout, layout);
  trajectories.layout = layout;
  return trajectories;
}

}  // namespace twinmap
