#pragma once

#include <Eigen/Core>

namespace twinmap {

/// The factor by which standard deviations must be multiplied so that both the 95 % and the 68 % interval
/// hold, from the absolute errors of samples that took no part in the training, each over its standard
/// deviation: the larger of the two conformal quantiles, each over that of the normal distribution. Below 1
/// only where the quantiles' upper confidence limits (97.5 %) are, and then the larger of these: claiming
/// less than the map does must be beyond doubt. More than 2000 samples leave little doubt: of errors with
/// heavier tails than normal ones, 50 % intervals would hold too much then, and the factor is one by which
/// 50 % intervals hold as much too much as 95 % intervals too little, the latter counting twice. Errors with
/// lighter tails keep the factor of the 68 % interval.
double calcStddevScale(const Eigen::VectorXd& absolute_z);

/// Geometric mean of each row of standard deviations.
Eigen::VectorXd calcTypicalStddev(const Eigen::MatrixXd& stddev);

}  // namespace twinmap
