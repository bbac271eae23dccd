#include "framework/models/mechanism/simbody/tree_dynamics.hpp"

#include <algorithm>
#include <cmath>

#include "framework/models/mechanism/equilibrium.hpp"

namespace twinmap {
namespace {

using SimTK::Mat33;
using SimTK::SpatialVec;
using SimTK::Vec3;

/// A pivot below this part of its diagonal entry makes the mass matrix singular.
constexpr double kSingularPivot = 1e-13;

double calcPower(const SpatialVec& velocity, const SpatialVec& force) {
  return SimTK::dot(velocity[0], force[0]) + SimTK::dot(velocity[1], force[1]);
}

/// Overwrites the lower triangle of `matrix` by its Cholesky factor.
void factorize(Eigen::MatrixXd& matrix) {
  for (Eigen::Index j = 0; j < matrix.rows(); ++j) {
    const double pivot = matrix(j, j) - matrix.row(j).head(j).squaredNorm();
    if (pivot <= kSingularPivot * matrix(j, j)) {  // false for NaN, which the integrator sees and rejects
      throw SimulationFailure(kSingularMassMatrix);
    }
    matrix(j, j) = std::sqrt(pivot);
    for (Eigen::Index i = j + 1; i < matrix.rows(); ++i) {
      matrix(i, j) = (matrix(i, j) - matrix.row(i).head(j).dot(matrix.row(j).head(j))) / matrix(j, j);
    }
  }
}

}  // namespace

TreeDynamics::TreeDynamics(const BodyTree& tree) : tree_(tree) {
  const SimTK::State& state = tree.getDefaultState();
  bodies_.resize(tree.getMatter().getNumBodies());
  for (std::size_t i = 1; i < bodies_.size(); ++i) {
    const SimTK::MobilizedBody& body = tree.getBody(static_cast<int>(i));
    bodies_[i].parent = static_cast<int>(body.getParentMobilizedBody().getMobilizedBodyIndex());
    bodies_[i].speed_count = body.getNumU(state);
    bodies_[i].first_speed = bodies_[i].speed_count > 0 ? static_cast<int>(body.getFirstUIndex(state)) : 0;
  }
  columns_.resize(state.getNU());
  mass_matrix_.setZero(state.getNU(), state.getNU());
  udot_.setZero(state.getNU());
}

const Eigen::VectorXd& TreeDynamics::calcUDot(const SimTK::State& state, const SystemForces& forces) {
  collectBodies(state, forces);
  std::copy(forces.on_speeds.begin(), forces.on_speeds.end(), udot_.begin());
  mass_matrix_.setZero();
  for (int i = static_cast<int>(bodies_.size()) - 1; i > 0; --i) {
    fillColumns(i);
    addToParent(bodies_[i]);
  }
  factorize(mass_matrix_);
  mass_matrix_.triangularView<Eigen::Lower>().solveInPlace(udot_);
  mass_matrix_.triangularView<Eigen::Lower>().transpose().solveInPlace(udot_);
  return udot_;
}

/// Reads kinematics and inertias; the force of a body includes its inertia forces at u' = 0.
void TreeDynamics::collectBodies(const SimTK::State& state, const SystemForces& forces) {
  for (std::size_t i = 1; i < bodies_.size(); ++i) {
    const SimTK::MobilizedBody& body = tree_.getBody(static_cast<int>(i));
    const SimTK::SpatialInertia& inertia = body.getBodySpatialInertiaInGround(state);
    Composite& composite = bodies_[i];
    composite.origin = body.getBodyOriginLocation(state);
    composite.mass = inertia.getMass();
    composite.first_moment = inertia.getMass() * inertia.getMassCenter();
    composite.inertia = inertia.getMass() * Mat33(inertia.getUnitInertia().asSymMat33());
    composite.force = forces.on_bodies[i] - tree_.getMatter().getTotalCentrifugalForces(
                                                state, SimTK::MobilizedBodyIndex(static_cast<int>(i)));
    for (int k = 0; k < composite.speed_count; ++k) {
      columns_[composite.first_speed + k] = body.getHCol(state, SimTK::MobilizerUIndex(k));
    }
  }
}

/// Generalized forces on the body's own speeds, and their columns of the mass matrix.
void TreeDynamics::fillColumns(int body) {
  const Composite& own = bodies_[body];
  for (int j = own.first_speed; j < own.first_speed + own.speed_count; ++j) {
    const Vec3& spin = columns_[j][0];
    const Vec3& velocity = columns_[j][1];
    SpatialVec momentum(own.inertia * spin + SimTK::cross(own.first_moment, velocity),
                        own.mass * velocity - SimTK::cross(own.first_moment, spin));
    udot_[j] += calcPower(columns_[j], own.force);
    for (int k = j; k < own.first_speed + own.speed_count; ++k) {
      mass_matrix_(k, j) = calcPower(columns_[k], momentum);
    }
    for (int child = body, above = own.parent; above > 0; child = above, above = bodies_[above].parent) {
      momentum[0] += SimTK::cross(bodies_[child].origin - bodies_[above].origin, momentum[1]);
      const int first = bodies_[above].first_speed;
      for (int k = first; k < first + bodies_[above].speed_count; ++k) {
        mass_matrix_(std::max(j, k), std::min(j, k)) = calcPower(columns_[k], momentum);
      }
    }
  }
}

void TreeDynamics::addToParent(const Composite& body) {
  if (body.parent == 0) {
    return;
  }
  Composite& parent = bodies_[body.parent];
  const Vec3 arm = body.origin - parent.origin;
  const Vec3& moment = body.first_moment;
  // Steiner's theorem for a point that is not the centre of mass
  const Mat33 outer = moment * ~arm + arm * ~moment + body.mass * (arm * ~arm);
  const double trace = 2.0 * SimTK::dot(moment, arm) + body.mass * SimTK::dot(arm, arm);
  parent.inertia += body.inertia + Mat33(trace) - outer;
  parent.first_moment += moment + body.mass * arm;
  parent.mass += body.mass;
  parent.force[0] += body.force[0] + SimTK::cross(arm, body.force[1]);
  parent.force[1] += body.force[1];
}

}  // namespace twinmap
