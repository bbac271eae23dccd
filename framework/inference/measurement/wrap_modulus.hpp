#pragma once

#include <Eigen/Core>

namespace twinmap {

/// The modulus of a counter that begins again and again, from its values alone. It is the median of its jumps
/// where few samples move by more than 15 % of the range. Else it makes the fourth differences of the
/// continued values least, to half of what continuing random values would leave. 0 where neither finds one
/// and where a value is missing. O(n).
double findModulus(const Eigen::VectorXd& times, const Eigen::VectorXd& values);

}  // namespace twinmap
