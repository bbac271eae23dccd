#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/experiment/model/model_spec.hpp"

namespace twinmap {

/// Columns of `points` (parameters x n), moved into the bounds of the parameters.
Eigen::MatrixXd clipToBounds(const Eigen::MatrixXd& points, const std::vector<ParameterSpec>& parameters);

/// A quantile of each row, linear between its sorted values (the default of R and NumPy). probability in
/// [0, 1]; values: rows x n, n >= 1.
Eigen::VectorXd calcRowQuantiles(const Eigen::MatrixXd& values, double probability);

}  // namespace twinmap
