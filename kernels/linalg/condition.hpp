#pragma once

#include "kernels/linalg/view.hpp"

namespace twinmap::linalg {

/// An estimate of the 1-norm condition number of L L' from its lower triangular factor: exact norm of L L'
/// (bounded by |L|_1 |L'|_1), Hager's lower bound for the inverse's (Higham, ACM TOMS 14, 1988), usually
/// within a factor of 3. Cost: about 10 n^2 flops.
double estimateCondition(ConstView lower);

}  // namespace twinmap::linalg
