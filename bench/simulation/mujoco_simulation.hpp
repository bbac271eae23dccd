#pragma once

#include <memory>

#include "bench/simulation/mechanism.hpp"

namespace twinmap::bench {

/// A mechanism by MuJoCo's Runge-Kutta method of order 4 with constant steps. One at a time: MuJoCo's control
/// callback is global.
class MujocoSimulation {
 public:
  /// `start`: coordinates at t = 0, where all is at rest; `times`: equidistant from one interval on. Throws
  /// std::runtime_error for a model that MuJoCo does not load or that has other coordinates.
  MujocoSimulation(const Mechanism& mechanism, Eigen::VectorXd start, const Eigen::VectorXd& times);

  /// Coordinate by coordinate, each at all times. `steps`: in each interval between times.
  Eigen::VectorXd simulate(const Point& parameters, int steps);

  double getInterval() const { return interval_; }  ///< between times, s

 private:
  const Mechanism& mechanism_;
  const Eigen::VectorXd start_;
  const Eigen::Index time_count_;
  const double interval_;
  std::unique_ptr<mjModel, void (*)(mjModel*)> model_;
  std::unique_ptr<mjData, void (*)(mjData*)> data_;
};

}  // namespace twinmap::bench
