#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/estimation/posterior/log_coordinates.hpp"
#include "framework/estimation/refined/misfit.hpp"

namespace twinmap {

/// chi-square and its linear model at a point, in LogCoordinates: with the whitened residual r and its
/// derivatives -J, chi_square(at + step) ~ chi_square - 2 step' descent + step' information step.
struct LocalSurface {
  bool simulated = false;  ///< if not, the rest is empty
  Eigen::VectorXd at;      ///< u
  double chi_square = 0.0;
  double degrees = 0.0;  ///< of freedom: residuals less the parameters that they determine
  Eigen::MatrixXd information;
  Eigen::VectorXd descent;
  Eigen::VectorXd residual;  ///< whitened
};

/// How well the simulator explains one measurement, over the box in LogCoordinates. One thread.
class MisfitSurface {
 public:
  /// All must outlive the object; `misfit` is that of `model`, of all unknown parameters.
  MisfitSurface(Misfit& misfit, const RefinementModel& model, const LogCoordinates& coordinates)
      : misfit_(misfit), model_(model), coordinates_(coordinates) {}

  Eigen::Index getDimensions() const { return coordinates_.getCount(); }
  int getSimulations() const { return misfit_.getSimulations(); }
  Misfit& updMisfit() { return misfit_; }
  const RefinementModel& getModel() const { return model_; }
  const LogCoordinates& getCoordinates() const { return coordinates_; }

  /// At all columns of `points` (u x n), one batch with derivatives.
  std::vector<LocalSurface> linearize(const Eigen::MatrixXd& points);
  /// chi-squares (n), infinite where a simulation fails; one batch. After linearize().
  Eigen::VectorXd calcChiSquares(const Eigen::MatrixXd& points);
  /// log of the posterior density (n) in these coordinates, but for a summand: normal noise, a prior that is
  /// uniform in the parameters, -infinity outside the bounds, where nothing is simulated.
  Eigen::VectorXd calcLogPosteriors(const Eigen::MatrixXd& points);

 private:
  Eigen::MatrixXd toBox(const Eigen::MatrixXd& points) const;

  Misfit& misfit_;
  const RefinementModel& model_;
  const LogCoordinates& coordinates_;
};

}  // namespace twinmap
