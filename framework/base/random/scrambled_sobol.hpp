#pragma once

#include <Eigen/Core>

#include "framework/base/random/random.hpp"

namespace twinmap {

/// The first `count` points (dimensions x count), in (0, 1), of Sobol's sequence, scrambled as Owen (1995)
/// does: each point is uniform, and all of them together fill the cube evenly, so that means of smooth
/// functions have errors that fall almost as fast as 1 / count; in powers of two they are best. The scramble
/// is that of Laine and Karras (2011) with the constants of Burley (2020), its keys the numbers of the stream
/// at (dimension, channel, replicate). At most 1000 dimensions.
Eigen::MatrixXd drawSobol(int dimensions, Eigen::Index count, const RandomStream& random,
                          std::uint64_t channel, std::uint64_t replicate);

}  // namespace twinmap
