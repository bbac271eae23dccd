#pragma once

#include <Eigen/Core>
#include <vector>

namespace twinmap {

/// An oscillating mode: the eigenvalues lambda and conj(lambda) of the linearised system.
struct Mode {
  double frequency;      ///< |lambda| / (2 pi), the undamped natural frequency, Hz
  double damping_ratio;  ///< -Re(lambda) / |lambda|, below 1; negative where the equilibrium is unstable
};

/// The oscillating modes of x' = A x for x = [coordinates; their time derivatives], by increasing frequency.
/// Eigenvalues whose imaginary part is below 1e-5 of the largest magnitude do not oscillate: those of
/// overdamped modes, and rounding errors of those of rigid body motion. Throws SimulationFailure for a matrix
/// that is not finite.
std::vector<Mode> calcModes(const Eigen::MatrixXd& state_matrix);

/// The matrix A of x' = A x for x = [coordinates; their time derivatives; states] in the directions that the
/// conditions of loops leave free: of x = [z; z'; states], coordinates = T z with orthonormal columns T that
/// span the null space of `slopes` (conditions x coordinates, of full rank).
Eigen::MatrixXd reduceToFreedoms(const Eigen::MatrixXd& state_matrix, const Eigen::MatrixXd& slopes);

/// The `count` lowest frequencies (Hz), then their damping ratios. Throws SimulationFailure as calcModes
/// does, and if fewer oscillate.
Eigen::VectorXd collectLowestModes(const Eigen::MatrixXd& state_matrix, int count);

}  // namespace twinmap
