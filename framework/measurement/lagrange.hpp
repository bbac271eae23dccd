#pragma once

#include <Eigen/Core>
#include <array>

namespace twinmap {

/// A value as a combination of consecutive samples: one that is there, or a polynomial through up to four.
struct Stencil {
  static constexpr int kPoints = 4;

  Eigen::Index first = 0;
  int count = 1;
  std::array<double, kPoints> weights{1.0, 1.0, 1.0, 1.0};
};

/// Lagrange's weights, at t, of the polynomial through `count` (1 to 4) points from `first` on. `times`:
/// distinct.
Stencil makeLagrange(const Eigen::VectorXd& times, Eigen::Index first, int count, double t);

/// sum of weights * values of the stencil.
double apply(const Stencil& stencil, const Eigen::Ref<const Eigen::VectorXd>& values);

}  // namespace twinmap
