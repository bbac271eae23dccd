#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "framework/data/features/feature_extractor.hpp"
#include "framework/data/noise/noise_whitener.hpp"
#include "framework/experiment/model/model_spec.hpp"
#include "framework/simulation/simulator.hpp"

namespace twinmap {

/// What a fit compares: features of the simulator with measured ones, in units of their noise. All members
/// must outlive the fit.
struct LeastSquaresProblem {
  const FeatureExtractor& extractor;
  const NoiseWhitener& noise;
  const std::vector<ParameterSpec>& parameters;  ///< p, all that is unknown (collectUnknown)
  const Eigen::VectorXd& measured;               ///< d, features
  Eigen::VectorXd inputs{};                      ///< q, known; behind the unknown in a point of the simulator

  Eigen::VectorXd makePoint(const Eigen::VectorXd& unknown) const;
};

struct LeastSquaresFit {
  Eigen::VectorXd parameters;   ///< p
  Eigen::MatrixXd information;  ///< p x p, Fisher information there, per width of the bounds
  double chi_square = 0.0;      ///< squared norm of the whitened residual
  int simulations = 0;
  bool converged = false;
  std::string message;  ///< why the search stopped
};

/// Classical model updating: the parameters within their bounds that minimise |W (features - measured)|^2, by
/// Levenberg and Marquardt's method (Eigen's port of MINPACK's lmder) from `start` (p, within the bounds).
/// The bounds are kept by p = centre + width / 2 sin(x) (James and Roos 1975). It finds the minimum in whose
/// basin it starts. A failed simulation is a step refused; if the start itself fails, or `max_simulations`
/// are used up, the fit has not converged. Cost: 2 p + 2 simulations an iteration, some 5 to 20 iterations.
LeastSquaresFit fitLeastSquares(Simulator& simulator, const LeastSquaresProblem& problem,
                                const Eigen::VectorXd& start, int max_simulations);

}  // namespace twinmap
