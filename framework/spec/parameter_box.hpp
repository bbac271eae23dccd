#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/spec/model_spec.hpp"

namespace twinmap {

/// Lower bounds, and upper minus lower bounds, of the parameters (p each), in their units.
inline Eigen::VectorXd calcLowerBounds(const std::vector<ParameterSpec>& parameters) {
  return Eigen::VectorXd::NullaryExpr(static_cast<Eigen::Index>(parameters.size()),
                                      [&](Eigen::Index j) { return parameters[j].bounds.lower; });
}

inline Eigen::VectorXd calcWidths(const std::vector<ParameterSpec>& parameters) {
  return Eigen::VectorXd::NullaryExpr(static_cast<Eigen::Index>(parameters.size()), [&](Eigen::Index j) {
    return parameters[j].bounds.upper - parameters[j].bounds.lower;
  });
}

/// The middle of the box.
inline Eigen::VectorXd calcBoxCenter(const std::vector<ParameterSpec>& parameters) {
  return Eigen::VectorXd::NullaryExpr(static_cast<Eigen::Index>(parameters.size()), [&](Eigen::Index j) {
    return 0.5 * (parameters[j].bounds.lower + parameters[j].bounds.upper);
  });
}

/// Standard deviation of a uniform distribution over a unit width.
constexpr double kUniformStddev = 0.28867513459481287;

}  // namespace twinmap
