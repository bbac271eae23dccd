#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace twinmap {

/// What the rows of a response are. First all outputs at all times, output by output: row o * times + i is
/// output o at times[i]. Then the natural frequencies (Hz) of the lowest modes of the system linearised at
/// its equilibrium, and then their damping ratios.
struct ResponseLayout {
  std::vector<std::string> output_names, output_units;
  Eigen::VectorXd times;  ///< s, strictly increasing
  int modes = 0;

  Eigen::Index getOutputCount() const { return static_cast<Eigen::Index>(output_names.size()); }
  Eigen::Index getRow(Eigen::Index output, Eigen::Index time) const { return output * times.size() + time; }
  Eigen::Index getFrequencyRow(Eigen::Index mode) const { return getOutputCount() * times.size() + mode; }
  Eigen::Index getDampingRow(Eigen::Index mode) const { return getFrequencyRow(modes + mode); }
  Eigen::Index getRowCount() const { return getDampingRow(modes); }
};

}  // namespace twinmap
