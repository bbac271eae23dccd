#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/models/mechanism/simbody/body_tree.hpp"

namespace twinmap {

/// Forces on all bodies (moment and force at the body's origin, in ground axes) and on all speeds.
struct SystemForces {
  std::vector<SimTK::SpatialVec> on_bodies;  ///< ground first
  std::vector<double> on_speeds;
};

/// Accelerations of a tree of bodies from the kinematics that Simbody computes: mass matrix and generalized
/// forces by the composite rigid body algorithm (Featherstone, Rigid Body Dynamics Algorithms, 2008, ch. 6),
/// then a Cholesky solve. Agrees with Simbody's realize(Acceleration) to rounding, at half its cost for the
/// few coordinates of a typical model: O(n depth) + O(n^3) for n speeds, without allocation.
class TreeDynamics {
 public:
  /// `tree` must be realized and outlive the object.
  explicit TreeDynamics(const BodyTree& tree);

  /// u' at a state that is realized to Velocity. Valid until the next call. Throws SimulationFailure if the
  /// mass matrix is singular.
  const Eigen::VectorXd& calcUDot(const SimTK::State& state, const SystemForces& forces);

 private:
  /// A body and all that it carries, about the body's origin and in ground axes.
  struct Composite {
    int parent, first_speed, speed_count;
    SimTK::Vec3 origin, first_moment;  ///< first moment: mass times centre of mass from the origin
    double mass;
    SimTK::Mat33 inertia;
    SimTK::SpatialVec force;
  };

  void collectBodies(const SimTK::State& state, const SystemForces& forces);
  void fillColumns(int body);
  void addToParent(const Composite& body);

  const BodyTree& tree_;
  std::vector<Composite> bodies_;           ///< ground first
  std::vector<SimTK::SpatialVec> columns_;  ///< velocity of a body per unit of each of its own speeds
  Eigen::MatrixXd mass_matrix_;             ///< lower triangle, then its Cholesky factor
  Eigen::VectorXd udot_;
};

}  // namespace twinmap
