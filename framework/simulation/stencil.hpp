#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/experiment/model/model_spec.hpp"

namespace twinmap {

/// How far beside a point, in widths of the parameters' bounds, simulations that share its integration steps
/// are differenced: rounding and truncation are then both far below the integration's own error.
constexpr double kSharedStepsDifference = 1e-4;

/// The points (2 p + 1 columns) from which derivatives to p parameters, the first rows of a point, come:
/// column 0 is the point, columns 2 j + 1 and 2 j + 2 are `step` widths of parameter j's bounds beside it, on
/// both sides, or one and two on the inner side where the step would leave the bounds. Other rows stay.
Eigen::MatrixXd makeNeighbours(const std::vector<ParameterSpec>& parameters, const Eigen::VectorXd& point,
                               double step = kSharedStepsDifference);

/// The same with a step for each parameter.
Eigen::MatrixXd makeNeighbours(const std::vector<ParameterSpec>& parameters, const Eigen::VectorXd& point,
                               const Eigen::VectorXd& steps);

/// The derivative per width of the bounds by one parameter, of value `at`, from the values at the point and
/// at its two neighbours.
Eigen::VectorXd calcDifference(const Eigen::Ref<const Eigen::VectorXd>& center,
                               const Eigen::Ref<const Eigen::MatrixXd>& neighbours, const Bounds& bounds,
                               double at, double step);

/// Differences of second order of values at these points (d x 2 p + 1): derivatives (d x p) per width of the
/// bounds.
Eigen::MatrixXd calcDifferences(const Eigen::MatrixXd& values, const std::vector<ParameterSpec>& parameters,
                                const Eigen::VectorXd& point, double step = kSharedStepsDifference);

}  // namespace twinmap
