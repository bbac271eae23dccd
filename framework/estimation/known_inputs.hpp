#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/experiment/model/model_spec.hpp"

namespace twinmap {

/// How known inputs enter the processes of a map: each as (value - center) / half_width, which is -1 to 1
/// within its bounds.
struct KnownInputs {
  Eigen::VectorXd center, half_width;  ///< q, in the inputs' units; may be empty

  /// Values (q x n) -> q x n. Throws std::invalid_argument for another number of inputs.
  Eigen::MatrixXd scale(const Eigen::MatrixXd& values) const;
};

KnownInputs makeKnownInputs(const std::vector<ParameterSpec>& inputs);

}  // namespace twinmap
