#pragma once

#include <Eigen/Core>
#include <array>

namespace twinmap {

/// A value as a combination of consecutive samples: one that is there, or a polynomial through up to four.
struct InterpolationWeights {
  static constexpr int kPoints = 4;

  Eigen::Index first = 0;
  int count = 1;
  std::array<double, kPoints> weights{1.0, 1.0, 1.0, 1.0};
};

/// Lagrange's weights, at t, of the polynomial through `count` (1 to 4) points from `first` on. `times`:
/// distinct.
InterpolationWeights makeLagrange(const Eigen::VectorXd& times, Eigen::Index first, int count, double t);

/// sum of weights * values of the weights_at.
double apply(const InterpolationWeights& weights_at, const Eigen::Ref<const Eigen::VectorXd>& values);

}  // namespace twinmap
