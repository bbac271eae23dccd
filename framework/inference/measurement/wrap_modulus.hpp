#pragma once

#include <Eigen/Core>

namespace twinmap {

/// The modulus of a counter that begins again and again, from its values alone. It is the median of its jumps
/// where few samples move by more than 15 % of the range. Else it makes the second differences of the
/// continued values least, to a tenth of those that were measured. 0 where neither finds one and where a
/// value is missing. O(n).
double findModulus(const Eigen::VectorXd& times, const Eigen::VectorXd& values);

}  // namespace twinmap
