#include "framework/models/mechanism/modes.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "framework/simulation/simulation_failure.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {

using Eigen::MatrixXd;
using Eigen::VectorXd;

std::vector<Mode> calcModes(const MatrixXd& state_matrix) {
  constexpr double kTwoPi = 6.283185307179586, kSmallest = 1e-5;
  if (state_matrix.size() == 0) {
    return {};
  }
  if (!state_matrix.allFinite()) {
    throw SimulationFailure("the linearisation at the equilibrium is not finite");
  }
  const Eigen::VectorXcd eigenvalues = linalg::calcEigenvalues(state_matrix);
  const double least = kSmallest * eigenvalues.cwiseAbs().maxCoeff();
  std::vector<Mode> modes;
  for (const std::complex<double>& eigenvalue : eigenvalues) {
    if (eigenvalue.imag() > least) {
      const double magnitude = std::abs(eigenvalue);
      modes.push_back({magnitude / kTwoPi, -eigenvalue.real() / magnitude});
    }
  }
  std::sort(modes.begin(), modes.end(),
            [](const Mode& a, const Mode& b) { return a.frequency < b.frequency; });
  return modes;
}

MatrixXd reduceToFreedoms(const MatrixXd& state_matrix, const MatrixXd& slopes) {
  const Eigen::Index n = slopes.cols(), free = n - slopes.rows(), states = state_matrix.rows() - 2 * n;
  // eigenvalues increase: those of the null space come first
  const MatrixXd basis = linalg::calcSymmetricEigen(slopes.transpose() * slopes).vectors.leftCols(free);
  MatrixXd expand = MatrixXd::Zero(2 * n + states, 2 * free + states);
  expand.topLeftCorner(n, free) = basis;
  expand.block(n, free, n, free) = basis;
  expand.bottomRightCorner(states, states).setIdentity();
  return expand.transpose() * state_matrix * expand;
}

VectorXd collectLowestModes(const MatrixXd& state_matrix, int count) {
  const std::vector<Mode> modes = calcModes(state_matrix);
  if (static_cast<int>(modes.size()) < count) {
    throw SimulationFailure(
        fmt::format("only {} of {} modes oscillate at the equilibrium", modes.size(), count));
  }
  VectorXd values(2 * count);
  for (int i = 0; i < count; ++i) {
    values[i] = modes[i].frequency;
    values[count + i] = modes[i].damping_ratio;
  }
  return values;
}

}  // namespace twinmap
