#pragma once

#include <Eigen/Core>

#include "framework/base/random/random.hpp"

namespace twinmap {

/// Independent standard normal numbers.
inline Eigen::MatrixXd makeNormal(Eigen::Index rows, Eigen::Index columns, std::uint64_t seed) {
  const RandomStream random(seed, RandomPurpose::kTrainNoise);
  return Eigen::MatrixXd::NullaryExpr(rows, columns, [&](Eigen::Index i, Eigen::Index j) {
    return random.calcNormal(static_cast<std::uint64_t>(j), static_cast<std::uint64_t>(i));
  });
}

}  // namespace twinmap
