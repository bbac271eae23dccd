#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/experiment/model/model_spec.hpp"

namespace twinmap {

/// What a measurement leaves unknown: the updating parameters, then the nuisance parameters.
std::vector<ParameterSpec> collectUnknown(const ModelSpec& model);

/// The sampled box: the updating parameters, then the nuisance parameters, then the inputs. This is the order
/// of a parameter point everywhere.
std::vector<ParameterSpec> collectSampled(const ModelSpec& model);
Eigen::Index countSampled(const ModelSpec& model);

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
/// 1 / variance of the same.
constexpr double kUniformInformation = 12.0;
/// The same in half-widths, for variables normalised to [-1, 1].
constexpr double kHalfWidthInformation = kUniformInformation / 4.0;

}  // namespace twinmap
