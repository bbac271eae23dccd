#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace twinmap {

/// The excitation as it is applied.
struct InputSignals {
  std::vector<std::string> names, units;
  Eigen::MatrixXd values;  ///< one row a time of the response's layout, one column a signal
};

}  // namespace twinmap
