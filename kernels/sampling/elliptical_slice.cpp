#include "kernels/sampling/elliptical_slice.hpp"

#include <cmath>

namespace twinmap::importance {

using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// One step from `at` along the ellipse through it and a new draw of the normal distribution: the angle is
/// drawn from a bracket that shrinks towards the place itself until the factor is above its slice.
void step(const TiltedNormal& density, const SliceNumbers& numbers, VectorXd& at, double& log_factor) {
  constexpr double kTurn = 6.283185307179586;
  constexpr int kMaxShrinks = 60;  // the bracket is then below rounding
  const VectorXd apart = at - density.mean;
  const VectorXd other = density.lower * numbers.normals(static_cast<int>(at.size()));
  const double slice = log_factor + std::log(numbers.uniform());
  double angle = kTurn * numbers.uniform();
  double low = angle - kTurn, high = angle;
  for (int i = 0; i < kMaxShrinks; ++i) {
    const VectorXd tried = density.mean + std::cos(angle) * apart + std::sin(angle) * other;
    const double reached = density.log_factor(tried);
    if (reached > slice) {
      at = tried;
      log_factor = reached;
      return;
    }
    (angle < 0.0 ? low : high) = angle;
    angle = low + (high - low) * numbers.uniform();
  }
}

}  // namespace

MatrixXd sampleEllipticalSlices(const TiltedNormal& density, const VectorXd& start, int draws, int steps,
                                const SliceNumbers& numbers) {
  constexpr int kFirst = 10;  // draws' worth of steps until the start is forgotten
  MatrixXd drawn(start.size(), draws);
  VectorXd at = start;
  double log_factor = density.log_factor(at);
  for (int i = 0; i < kFirst * steps; ++i) {
    step(density, numbers, at, log_factor);
  }
  for (int i = 0; i < draws; ++i) {
    for (int k = 0; k < steps; ++k) {
      step(density, numbers, at, log_factor);
    }
    drawn.col(i) = at;
  }
  return drawn;
}

}  // namespace twinmap::importance
