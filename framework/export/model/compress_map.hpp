#pragma once

#include <Eigen/Core>

#include "framework/estimation/gp/gp_map.hpp"

namespace twinmap {

/// A map whose processes keep so few inducing inputs that its answers just stay what they were.
struct CompressedMap {
  GpMap map;               ///< all that is stored as float is rounded to it
  double mean_loss = 0;    ///< largest of the parameters: root mean square change of the mean, in sd
  double stddev_loss = 0;  ///< and of the standard deviation, relative
};

/// What the losses are measured with.
struct CompressionTest {
  Eigen::MatrixXd features;  ///< d x n, of measurements that the map was not trained on
  Eigen::MatrixXd known;     ///< q x n
};

/// Compresses each exact process by the fewest inducing inputs (gp::compress) with which neither loss is
/// above `most`. Throws ExperimentError where a process cannot be compressed: one that is sparse already, has
/// a linear covariance term, or needs more than half of its inputs. Cost: some 8 compressions a process.
CompressedMap compressMap(const GpMap& exact, const CompressionTest& test, double most);

}  // namespace twinmap
