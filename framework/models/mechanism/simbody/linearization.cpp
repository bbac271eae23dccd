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

  MatrixXd calc(const VectorXd& equilibrium) {
    const Index n = static_cast<Index>(system_.getTree().getSlots().size()), m = equilibrium.size() - n;
    const InitialState center{equilibrium.head(n), VectorXd::Zero(n), equilibrium.tail(m)};
    MatrixXd matrix = MatrixXd::Zero(2 * n + m, 2 * n + m);
    matrix.block(0, n, n, n).setIdentity();
    for (Index i = 0; i < n; ++i) {
      matrix.col(i).tail(n + m) = calcDifference(center, &InitialState::coordinates, i);
      matrix.col(n + i).tail(n + m) = calcDifference(center, &InitialState::speeds, i);
    }
    for (Index i = 0; i < m; ++i) {
      matrix.col(2 * n + i).tail(n + m) = calcDifference(center, &InitialState::states, i);
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
    return (calcChanges(forward) - calcChanges(backward)) / distance;
  }

  /// Second time derivatives of the coordinates, then the rates of the states of first order.
  VectorXd calcChanges(const InitialState& at) {
    setState(system_, at, state_);
    const VectorXd& udot = system_.calcUDot(state_, 0.0);
    SimTK::Vector u_dot(static_cast<int>(udot.size())), q_dot_dot;
    std::copy(udot.begin(), udot.end(), u_dot.updContiguousScalarData());
    system_.getTree().getMatter().calcQDotDot(state_, u_dot, q_dot_dot);
    VectorXd changes(at.coordinates.size() + at.states.size());
    const std::vector<BodyTree::Slot>& slots = system_.getTree().getSlots();
    for (Index i = 0; i < at.coordinates.size(); ++i) {
      changes[i] = q_dot_dot[slots[i].q];
    }
    std::copy(system_.getStateRates().begin(), system_.getStateRates().end(),
              changes.begin() + at.coordinates.size());
    return changes;
  }

  LoadedSystem& system_;
  SimTK::State state_;
};

}  // namespace

MatrixXd calcStateMatrix(LoadedSystem& system, const VectorXd& equilibrium) {
  return Linearization(system).calc(equilibrium);
}

}  // namespace twinmap
