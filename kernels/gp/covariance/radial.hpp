#pragma once

#include <Eigen/Core>

#include "kernels/gp/covariance/covariance.hpp"

namespace twinmap::gp {

/// A column that starts on a full vector register and is a whole number of registers long, so that every
/// element takes the same (vectorised) path whatever its position: results repeat to the last bit.
using AlignedColumn = Eigen::Map<Eigen::ArrayXd, Eigen::AlignedMax>;
using ConstAlignedColumn = Eigen::Map<const Eigen::ArrayXd, Eigen::AlignedMax>;

/// From q = r^2 (>= 0): value = k(q) and weight = -2 dk/dq, both finite at q = 0. With q_g the share of
/// length scale l_g in q, dk / dlog l_g = weight q_g. None may overlap.
void evaluateRadial(CovarianceFunction covariance, double shape, ConstAlignedColumn squared_distance,
                    AlignedColumn value, AlignedColumn weight);

/// dk / dlog a of the rational quadratic.
void evaluateShapeDerivative(double shape, ConstAlignedColumn squared_distance, AlignedColumn derivative);

}  // namespace twinmap::gp
