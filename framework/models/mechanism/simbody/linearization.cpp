#include "framework/models/mechanism/simbody/linearization.hpp"

#include <algorithm>
#include <cmath>

#include "framework/models/mechanism/simbody/initial_state.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

class Linearization {
 public:
  explicit Linearization(LoadedSystem& system)
      : system_(system), state_(system.getTree().getDefaultState()) {}

  MatrixXd calc(const VectorXd& coordinates) {
    const Index n = coordinates.size();
    const InitialState center{coordinates, VectorXd::Zero(n)};
    MatrixXd matrix = MatrixXd::Zero(2 * n, 2 * n);
    matrix.topRightCorner(n, n).setIdentity();
    for (Index i = 0; i < n; ++i) {
      matrix.col(i).tail(n) = calcDifference(center, &InitialState::coordinates, i);
      matrix.col(n + i).tail(n) = calcDifference(center, &InitialState::speeds, i);
    }
    return matrix;
  }

 private:
  VectorXd calcDifference(const InitialState& center, VectorXd InitialState::*varied, Index i) {
    InitialState forward = center, backward = center;
    const double step = kDifferenceStep * (1.0 + std::abs((center.*varied)[i]));
    (forward.*varied)[i] += step;
    (backward.*varied)[i] -= step;
    const double distance = (forward.*varied)[i] - (backward.*varied)[i];
    return (calcAccelerations(forward) - calcAccelerations(backward)) / distance;
  }

  /// Second time derivatives of the coordinates.
  VectorXd calcAccelerations(const InitialState& at) {
    setState(system_, at, state_);
    const VectorXd& udot = system_.calcUDot(state_, 0.0);
    SimTK::Vector u_dot(static_cast<int>(udot.size())), q_dot_dot;
    std::copy(udot.begin(), udot.end(), u_dot.updContiguousScalarData());
    system_.getTree().getMatter().calcQDotDot(state_, u_dot, q_dot_dot);
    VectorXd accelerations(at.coordinates.size());
    const std::vector<BodyTree::Slot>& slots = system_.getTree().getSlots();
    for (Index i = 0; i < accelerations.size(); ++i) {
      accelerations[i] = q_dot_dot[slots[i].q];
    }
    return accelerations;
  }

  LoadedSystem& system_;
  SimTK::State state_;
};

}  // namespace

MatrixXd calcStateMatrix(LoadedSystem& system, const VectorXd& coordinates) {
  return Linearization(system).calc(coordinates);
}

}  // namespace twinmap
