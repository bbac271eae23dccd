#pragma once

#include <Eigen/Core>
#include <vector>

namespace twinmap {

/// The error (root mean square over `needed` times) of the cubic through the four nearest of samples whose
/// noise is of `stddev`: by how much the polynomial through the six nearest differs from it, which is nearly
/// all of it while the samples are three or more a period, less what noise makes of that. Needed times among
/// steps of more than 1.5 median ones do not count: nothing is interpolated there. 0 where no needed time
/// lies between samples. O(needed log samples).
double calcInterpolationError(const Eigen::VectorXd& times, const Eigen::VectorXd& values,
                              const std::vector<double>& needed, double stddev);

}  // namespace twinmap
