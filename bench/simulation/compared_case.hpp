#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>

#include "bench/simulation/mechanism.hpp"
#include "framework/experiment/experiment_spec.hpp"
#include "framework/models/mechanism/simulator/multibody_simulator.hpp"

namespace twinmap::bench {

/// The experiment of a mechanism with as many points, uniform in the box, for sampleTestPoints().
ExperimentSpec loadMechanism(const Mechanism& mechanism, int points);

/// The experiment's model with another relative tolerance, and the absolute one in the ratio of the defaults.
ModelSpec withTolerance(ModelSpec model, double relative);

/// Column by column, in the simulator's batches. Throws std::runtime_error where a sample fails.
Eigen::MatrixXd simulateAll(MultibodySimulator& simulator, const Eigen::MatrixXd& points);
void requireSuccess(const std::vector<SampleStatus>& statuses);

/// A mechanism with the solution that errors are measured from: that of its first twelve points in lanes at
/// the tightest relative tolerance there is, 1e-13.
class ComparedCase {
 public:
  ComparedCase(const Mechanism& mechanism, int points);

  const Mechanism& getMechanism() const { return mechanism_; }
  const ExperimentSpec& getExperiment() const { return experiment_; }
  const Eigen::VectorXd& getTimes() const { return times_; }
  const Eigen::MatrixXd& getPoints() const { return points_; }

  /// Coordinates at t = 0, the same for all points: the outputs are the coordinates.
  Eigen::VectorXd calcStart() const;

  /// The largest deviation of the responses `simulate(i)` of points from the solution, over points, outputs
  /// and times, in parts of each output's range.
  double calcError(const std::function<Eigen::MatrixXd(Eigen::Index)>& simulate) const;

 private:
  const Mechanism mechanism_;
  const ExperimentSpec experiment_;
  const Eigen::VectorXd times_;
  const Eigen::MatrixXd points_;
  const Eigen::MatrixXd reference_;
};

}  // namespace twinmap::bench
