#pragma once

#include <Eigen/Core>
#include <string>

#include "framework/estimation/interval_factor.hpp"
#include "framework/estimation/mixture.hpp"

namespace twinmap {

/// What came of a refinement.
enum class RefinementStatus {
  kAccepted,    ///< the answer explains the features, and its covariance is that of the misfit around it
  kMisfit,      ///< chi-square is too large: another basin, or a model that is wrong
  kNonlinear,   ///< the misfit around the answer is not a paraboloid: no covariance describes it
  kMultimodal,  ///< the map knows of other answers, which least squares from one of them does not see
  kFailed       ///< simulations failed, or the search did not converge
};

/// "accepted", "misfit", "nonlinear", "multimodal", "failed".
const char* toString(RefinementStatus status);

struct Refined;

/// Withdraws the acceptance where other answers fit as well.
void rejectAsMultimodal(Refined& refined);

/// What least squares on the simulator make of a measurement.
struct Refined {
  RefinementStatus status = RefinementStatus::kFailed;
  std::string message;           ///< why it is not accepted; empty if it is
  Eigen::VectorXd point;         ///< of the sampled box; the best that was found
  Eigen::MatrixXd covariance;    ///< s x s of the searched parameters, in their units; empty unless accepted
  Eigen::VectorXd mean, stddev;  ///< s, of the searched parameters, in their units; empty unless accepted
  /// Where the data leave one direction to the box (traceRidge()): mean and stddev are then those of the
  /// values along it, which intervals of mean +- factor stddev hold, and `covariance` is that of the linear
  /// model at the point. Empty elsewhere.
  Mixture ridge{};
  IntervalFactors interval_factors{};  ///< s x 1
  double chi_square = 0.0;             ///< of the residual, in noise variances
  double degrees = 0.0;                ///< of freedom of the residual; 0 where nothing could be simulated
  Eigen::VectorXd residual;            ///< of all features, in noise standard deviations; empty likewise
  bool explained = false;  ///< whether noise explains chi_square (calcChiSquareLimit), accepted or not
  double distance = 0.0;   ///< from the first start, in standard deviations (Mahalanobis)
  int iterations = 0;      ///< of all attempts
  int simulations = 0;     ///< those with derivatives count once
  std::string start;       ///< the start that led there

  /// chi_square over degrees; infinite where nothing could be simulated.
  double calcReducedChiSquare() const;
  bool isAccepted() const { return status == RefinementStatus::kAccepted; }
  /// Whether the point is a minimum of the misfit, be it accepted or not.
  bool hasConverged() const { return status != RefinementStatus::kFailed; }
};

}  // namespace twinmap
