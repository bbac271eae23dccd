#pragma once

#include <Eigen/Core>

namespace twinmap {

/// The factor by which standard deviations must be multiplied so that both the 95 % and the 68 % interval
/// hold, from the absolute errors of samples that took no part in the training, each over its standard
/// deviation: the larger of the two conformal quantiles, each over that of the normal distribution. Below 1
/// only where the quantiles' upper confidence limits (97.5 %) are, and then the larger of these: claiming
/// less than the map does must be beyond doubt.
double calcStddevScale(const Eigen::VectorXd& absolute_z);

/// The same, of quantiles one standard error lower: what the factor is at least, rather than by chance.
double calcLeastStddevScale(const Eigen::VectorXd& absolute_z);

}  // namespace twinmap
