#pragma once

#include <Eigen/Core>

namespace twinmap {

/// With more than this share of the standard deviation that was there before, a parameter is hardly better
/// known.
constexpr double kUninformativeShare = 0.9;

/// Whether one of the parameters is hardly better known than before. Both of one size and unit.
inline bool isUninformative(const Eigen::Ref<const Eigen::VectorXd>& stddev,
                            const Eigen::Ref<const Eigen::VectorXd>& prior_stddev) {
  return (stddev.array() > kUninformativeShare * prior_stddev.array()).any();
}

}  // namespace twinmap
