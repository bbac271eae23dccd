#include "framework/data/features/layout_rows.hpp"

#include <algorithm>
#include <stdexcept>

namespace twinmap {

Eigen::Index findOutput(const ResponseLayout& layout, const std::string& output) {
  const auto found = std::find(layout.output_names.begin(), layout.output_names.end(), output);
  if (found == layout.output_names.end()) {
    throw std::invalid_argument("feature of an unknown output '" + output + "'");
  }
  return found - layout.output_names.begin();
}

Eigen::Index findTime(const ResponseLayout& layout, double time) {
  const Eigen::VectorXd& times = layout.times;
  const double* found = std::lower_bound(times.data(), times.data() + times.size(), time);
  if (found == times.data() + times.size() || *found != time) {
    throw std::invalid_argument("feature at a time that the responses lack");
  }
  return found - times.data();
}

std::vector<Eigen::Index> findRows(const ResponseLayout& layout, Eigen::Index output,
                                   const WindowSpec& window) {
  std::vector<Eigen::Index> rows;
  for (int i = 0; i < window.count; ++i) {
    rows.push_back(layout.getRow(output, findTime(layout, calcSampleTime(window, i))));
  }
  return rows;
}

}  // namespace twinmap
