#pragma once

#include <Eigen/Core>

namespace twinmap {

/// What a segment says of its initial state before anything is measured: normal, wide, independent.
struct StatePrior {
  Eigen::VectorXd precision;  ///< s, 1 / standard deviation
  Eigen::VectorXd ahead;      ///< s, mean less the state at which the segment was simulated
};

/// A segment's linear model with its initial state eliminated. With whitened residuals r of n rows, in time's
/// order, and the response's derivatives A (n x s) with respect to the state and J (n x u) with respect to
/// the parameters, the misfit at the best state is
///   min over x of |r - A x - J p|^2 + |precision (ahead - x)|^2 = |residual - jacobian p|^2,
/// where `residual` = W r and `jacobian` = W J are recursive residuals (Brown, Durbin and Evans 1975): row t
/// is what the rows before it do not predict, over its standard deviation. Of white noise they are white, of
/// unit variance, but for the first rows, which the state takes: about 0.
struct StateElimination {
  Eigen::VectorXd residual;  ///< n
  Eigen::MatrixXd jacobian;  ///< n x u
  Eigen::VectorXd step;      ///< s: to the best state
  Eigen::MatrixXd slopes;    ///< s x u: of the best state with respect to the parameters
  double told = 0.0;         ///< how many states the rows tell, rather than the prior
  double gain = 0.0;         ///< misfit here less that at the best state
};

/// By plane rotations, a row after the other. n s (s + u) multiplications, some four times.
StateElimination eliminateState(const Eigen::VectorXd& residual, const Eigen::MatrixXd& by_state,
                                const Eigen::MatrixXd& by_parameters, const StatePrior& prior);

}  // namespace twinmap
