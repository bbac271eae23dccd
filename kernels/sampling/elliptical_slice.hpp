#pragma once

#include <Eigen/Core>
#include <functional>

namespace twinmap::importance {

/// A density in proportion to N(x; mean, lower lower') f(x).
struct TiltedNormal {
  Eigen::VectorXd mean;   ///< u
  Eigen::MatrixXd lower;  ///< u x u
  /// log f at x, but for a summand; -infinity where the density is 0.
  std::function<double(const Eigen::VectorXd& x)> log_factor;
};

/// Random numbers one after the other.
struct SliceNumbers {
  std::function<double()> uniform;              ///< in (0, 1)
  std::function<Eigen::VectorXd(int)> normals;  ///< so many, standard normal
};

/// Draws (u x n) of a tilted normal distribution by elliptical slice sampling (Murray, Adams and MacKay
/// 2010): every step is accepted, nothing is tuned, and where f is constant two steps are independent.
/// `start`: u, where f is above 0. `steps`: between two draws; ten times as many come before the first one.
/// Cost: some factors and one product with `lower` a step.
Eigen::MatrixXd sampleEllipticalSlices(const TiltedNormal& density, const Eigen::VectorXd& start, int draws,
                                       int steps, const SliceNumbers& numbers);

}  // namespace twinmap::importance
