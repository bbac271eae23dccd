#pragma once

#include <utility>
#include <vector>

#include "framework/models/mechanism/equations/joints.hpp"

namespace twinmap::equations {

/// A body in the ground frame, at its origin: pose, velocity, the velocity for a unit of each of its joint's
/// speeds, and the acceleration that all speeds cause alone (at u' = 0).
template <class S>
struct BodyMotion {
  Transform<S> pose;
  Spatial<S> velocity, bias;
  std::vector<Spatial<S>> columns;
};

/// Motion of a body from that of its parent.
template <class S>
BodyMotion<S> calcBodyMotion(const BodyValues<S>& body, const BodyMotion<S>& parent, const S* q, const S* u) {
  const JointMotion<S> joint = calcJoint(body, q, u);
  const Transform<S> fixed = parent.pose * body.in_parent;
  BodyMotion<S> motion;
  const Transform<S> moving = fixed * joint.frame;
  motion.pose = moving * invert(body.in_body);
  const Vec3<S> arm = motion.pose.origin - moving.origin;  // from the joint to the body's origin
  Spatial<S> relative;
  for (std::size_t k = 0; k < joint.columns.size(); ++k) {
    const Vec3<S> spin = fixed.rotation * joint.columns[k].angular;
    motion.columns.push_back({spin, fixed.rotation * joint.columns[k].linear + cross(spin, arm)});
    relative = relative + scale(u[k], motion.columns.back());
  }
  const Vec3<S> reach = motion.pose.origin - parent.pose.origin;
  const Vec3<S>&spin = parent.velocity.angular, &turn = relative.angular;
  motion.velocity = {spin + turn, parent.velocity.linear + cross(spin, reach) + relative.linear};
  const Vec3<S> own_turn = fixed.rotation * joint.bias.angular;
  const Vec3<S> own =
      fixed.rotation * joint.bias.linear + cross(own_turn, arm) + cross(turn, cross(turn, arm));
  motion.bias.angular = parent.bias.angular + cross(spin, turn) + own_turn;
  motion.bias.linear = parent.bias.linear + cross(parent.bias.angular, reach) +
                       cross(spin, cross(spin, reach)) + scale(S(2.0), cross(spin, relative.linear)) + own;
  return motion;
}

/// All bodies, ground first.
template <class S>
std::vector<BodyMotion<S>> calcMotions(const SystemValues<S>& system, const std::vector<S>& q,
                                       const std::vector<S>& u) {
  std::vector<BodyMotion<S>> motions(1);
  for (std::size_t i = 1; i < system.bodies.size(); ++i) {
    const BodyValues<S>& body = system.bodies[i];
    motions.push_back(
        calcBodyMotion(body, motions[body.parent], q.data() + body.first_speed, u.data() + body.first_speed));
  }
  return motions;
}

/// A body and all that it carries, about the body's origin and in ground axes.
template <class S>
struct Composite {
  S mass;
  Vec3<S> first_moment;  ///< mass times centre of mass from the origin
  Mat33<S> inertia;
  Spatial<S> force;  ///< what acts on it less its inertia forces at u' = 0
};

template <class S>
Composite<S> calcComposite(const BodyValues<S>& body, const BodyMotion<S>& motion,
                           const Spatial<S>& applied) {
  const Mat33<S>& axes = motion.pose.rotation;
  const Vec3<S>&spin = motion.velocity.angular, &turn = motion.bias.angular;
  Composite<S> own;
  own.mass = body.mass;
  own.first_moment = axes * scale(body.mass, body.center);
  own.inertia = axes * body.inertia * transpose(axes);
  const Vec3<S> force = scale(body.mass, motion.bias.linear) + cross(turn, own.first_moment) +
                        cross(spin, cross(spin, own.first_moment));
  const Vec3<S> moment =
      own.inertia * turn + cross(spin, own.inertia * spin) + cross(own.first_moment, motion.bias.linear);
  own.force = applied - Spatial<S>{moment, force};
  return own;
}

/// Adds a child whose origin is at `arm`, by Steiner's theorem for a point that is not the centre of mass.
template <class S>
void addChild(const Composite<S>& child, const Vec3<S>& arm, Composite<S>& parent) {
  const Vec3<S>& moment = child.first_moment;
  const S trace = S(2.0) * dot(moment, arm) + child.mass * dot(arm, arm);
  parent.inertia = parent.inertia + child.inertia + makeDiagonal(trace) -
                   (outer(moment, arm) + outer(arm, moment) + scale(child.mass, outer(arm, arm)));
  parent.first_moment = parent.first_moment + moment + scale(child.mass, arm);
  parent.mass = parent.mass + child.mass;
  parent.force =
      parent.force + Spatial<S>{child.force.angular + cross(arm, child.force.linear), child.force.linear};
}

/// A symmetric system of equations; of the matrix the lower triangle, row by row.
template <class S>
struct LinearSystem {
  std::vector<std::vector<S>> matrix;
  std::vector<S> right;
};

/// The rows and columns of the mass matrix that belong to one body's speeds.
template <class S>
void fillBody(const SystemValues<S>& system, const std::vector<BodyMotion<S>>& motions,
              const Composite<S>& own, int body, LinearSystem<S>& equations) {
  const int first = system.bodies[body].first_speed;
  for (int j = 0; j < system.bodies[body].speed_count; ++j) {
    const Spatial<S>& column = motions[body].columns[j];
    equations.right[first + j] = equations.right[first + j] + dot(column, own.force);
    Spatial<S> momentum{own.inertia * column.angular + cross(own.first_moment, column.linear),
                        scale(own.mass, column.linear) - cross(own.first_moment, column.angular)};
    for (int k = 0; k <= j; ++k) {
      equations.matrix[first + j][first + k] = dot(motions[body].columns[k], momentum);
    }
    for (int child = body, above = system.bodies[body].parent; above > 0;
         child = above, above = system.bodies[above].parent) {
      const Vec3<S> arm = motions[child].pose.origin - motions[above].pose.origin;
      momentum.angular = momentum.angular + cross(arm, momentum.linear);
      for (int k = 0; k < system.bodies[above].speed_count; ++k) {
        equations.matrix[first + j][system.bodies[above].first_speed + k] =
            dot(motions[above].columns[k], momentum);
      }
    }
  }
}

/// Mass matrix and generalized forces by the composite rigid body algorithm (Featherstone, Rigid Body
/// Dynamics Algorithms, 2008, ch. 6). `on_bodies`: moments and forces at the bodies' origins in ground axes;
/// `on_speeds`: generalized forces. The entries of bodies on different branches are literally 0.
template <class S>
LinearSystem<S> calcEquationsOfMotion(const SystemValues<S>& system,
                                      const std::vector<BodyMotion<S>>& motions,
                                      const std::vector<Spatial<S>>& on_bodies, std::vector<S> on_speeds) {
  std::vector<Composite<S>> composites;
  for (std::size_t i = 0; i < motions.size(); ++i) {
    composites.push_back(calcComposite(system.bodies[i], motions[i], on_bodies[i]));
  }
  LinearSystem<S> equations{{}, std::move(on_speeds)};
  for (std::size_t j = 0; j < equations.right.size(); ++j) {
    equations.matrix.emplace_back(j + 1, S(0.0));
  }
  for (int i = static_cast<int>(motions.size()) - 1; i > 0; --i) {
    fillBody(system, motions, composites[i], i, equations);
    const int parent = system.bodies[i].parent;
    if (parent > 0) {
      addChild(composites[i], motions[i].pose.origin - motions[parent].pose.origin, composites[parent]);
    }
  }
  for (const auto& [coordinate, inertia] : system.armature) {
    S& own = equations.matrix[coordinate][coordinate];
    own = own + inertia;
  }
  return equations;
}

/// A pivot below this part of its diagonal entry makes the mass matrix singular.
constexpr double kSingularPivot = 1e-13;

/// A symmetric matrix as L D L', eliminated from the last row to the first, so that zeros between branches of
/// a tree stay literally zeros (Featherstone 2008, 6.5: every row's nonzero columns are its ancestors, and
/// elimination from the leaves fills nothing).
template <class S>
struct Factors {
  std::vector<std::vector<S>> rows;  ///< of L, without its diagonal of ones
  std::vector<S> inverse;            ///< of D
  std::vector<S> pivots;             ///< positive where the matrix is regular: D - smallest * diagonal entry
};

/// `matrix`: its lower triangle, row by row. `smallest`: the part of its diagonal entry that a pivot must
/// exceed. `right`: empty, or a right side that is eliminated along the way, for substitute().
template <class S>
Factors<S> factorize(std::vector<std::vector<S>> matrix, double smallest, std::vector<S>& right) {
  const int n = static_cast<int>(matrix.size());
  Factors<S> factors{{}, std::vector<S>(n, S(0.0)), std::vector<S>(n, S(0.0))};
  std::vector<S> diagonal;
  for (int i = 0; i < n; ++i) {
    diagonal.push_back(matrix[i][i]);
  }
  for (int k = n - 1; k >= 0; --k) {
    factors.pivots[k] = matrix[k][k] - S(smallest) * diagonal[k];
    factors.inverse[k] = S(1.0) / matrix[k][k];
    std::vector<S> row;
    for (int i = 0; i < k; ++i) {
      row.push_back(matrix[k][i] * factors.inverse[k]);
    }
    for (int i = 0; i < k; ++i) {
      for (int j = 0; j <= i; ++j) {
        matrix[i][j] = matrix[i][j] - row[i] * matrix[k][j];
      }
      if (!right.empty()) {
        right[i] = right[i] - row[i] * right[k];
      }
    }
    matrix[k] = std::move(row);
  }
  factors.rows = std::move(matrix);
  return factors;
}

/// The solution from a right side that is eliminated.
template <class S>
std::vector<S> substitute(const Factors<S>& factors, std::vector<S> right) {
  for (std::size_t k = 0; k < right.size(); ++k) {
    S value = right[k] * factors.inverse[k];
    for (std::size_t i = 0; i < k; ++i) {
      value = value - factors.rows[k][i] * right[i];
    }
    right[k] = value;
  }
  return right;
}

/// The solution for a right side.
template <class S>
std::vector<S> solve(const Factors<S>& factors, std::vector<S> right) {
  for (std::size_t k = right.size(); k-- > 0;) {
    for (std::size_t i = 0; i < k; ++i) {
      right[i] = right[i] - factors.rows[k][i] * right[k];
    }
  }
  return substitute(factors, std::move(right));
}

}  // namespace twinmap::equations
