#pragma once

#include <Eigen/Core>

namespace twinmap {

/// What is inferred from one measurement.
struct Inference {
  Eigen::VectorXd mean, stddev;  ///< p, in the parameters' units
  Eigen::VectorXd
      limit_stddev;  ///< p, what the measurement allows as the map foretells it; empty if it cannot
  Eigen::MatrixXd correlation{};  ///< p x p, of this measurement's errors, where the map tells; else empty
  Eigen::VectorXd inputs{};       ///< what the map sees of the features and known inputs, k
};

}  // namespace twinmap
