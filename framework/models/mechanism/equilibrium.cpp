#include "framework/models/mechanism/equilibrium.hpp"

#include <cmath>
#include <cstdio>

#include "framework/simulation/simulation_failure.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {
namespace {

constexpr int kMaxIterations = 50;
constexpr double kStepTolerance = 1e-11;      ///< m or rad, relative to 1 + |coordinate|
constexpr double kResidualTolerance = 1e-12;  ///< of the largest acceleration met

class EquilibriumSolver {
 public:
  explicit EquilibriumSolver(RestAccelerations& system) : system_(system) {}

  Eigen::VectorXd solve(Eigen::VectorXd q) {
    Eigen::VectorXd residual = system_.calc(q);
    for (int i = 0; i < kMaxIterations; ++i) {
      largest_ = std::max(largest_, residual.lpNorm<Eigen::Infinity>());
      if (residual.lpNorm<Eigen::Infinity>() <= kResidualTolerance * largest_) {
        return q;
      }
      const Eigen::VectorXd step = -linalg::solveMinimumNorm(system_.calcJacobian(q), residual);
      const double length = moveAlong(step, q, residual);
      const double change = length * (step.array().abs() / (1.0 + q.array().abs())).maxCoeff();
      if (change <= kStepTolerance && length == 1.0 && isSmall(residual)) {
        return q;
      }
      if (length == 0.0) {
        break;
      }
    }
    return acceptOrThrow(q, residual);
  }

 private:
  /// Halves the step until the residual shrinks; returns the part of the step taken, 0 if none helped.
  double moveAlong(const Eigen::VectorXd& step, Eigen::VectorXd& q, Eigen::VectorXd& residual) {
    for (double length = 1.0; length > 1e-6; length *= 0.5) {
      const Eigen::VectorXd trial = system_.calc(q + length * step);
      if (trial.norm() < residual.norm()) {
        q += length * step;
        residual = trial;
        return length;
      }
    }
    return 0.0;
  }

  /// Rounding leaves accelerations of this size; a true equilibrium is not worse.
  bool isSmall(const Eigen::VectorXd& residual) const {
    return residual.lpNorm<Eigen::Infinity>() <= 1e-9 * std::max(largest_, 1.0);
  }

  Eigen::VectorXd acceptOrThrow(const Eigen::VectorXd& q, const Eigen::VectorXd& residual) const {
    if (isSmall(residual)) {
      return q;
    }
    char text[120];
    std::snprintf(
        text, sizeof text,
        "static equilibrium not found: largest acceleration, or rate of a state, left %.3g (SI units)",
        residual.lpNorm<Eigen::Infinity>());
    throw SimulationFailure(text);
  }

  RestAccelerations& system_;
  double largest_ = 0.0;
};

}  // namespace

void holdIndifferentStates(const Eigen::VectorXd& rates, Eigen::Index coordinates,
                           Eigen::MatrixXd& jacobian) {
  for (Eigen::Index i = coordinates; i < rates.size(); ++i) {
    if (rates[i] == 0.0 && (jacobian.row(i).array() == 0.0).all()) {
      jacobian.col(i).setZero();
    }
  }
}

Eigen::VectorXd insertSpeeds(const Eigen::VectorXd& equilibrium, const Eigen::VectorXd& speeds) {
  const Eigen::Index n = speeds.size(), m = equilibrium.size() - n;
  Eigen::VectorXd all(2 * n + m);
  all << equilibrium.head(n), speeds, equilibrium.tail(m);
  return all;
}

Eigen::VectorXd solveEquilibrium(RestAccelerations& system, const Eigen::VectorXd& start) {
  return start.size() == 0 ? start : EquilibriumSolver(system).solve(start);
}

}  // namespace twinmap
