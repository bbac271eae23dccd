#pragma once

#include <optional>

#include "framework/data/sensitivity/feature_sensitivities.hpp"
#include "framework/estimation/refined/refinement_model.hpp"
#include "framework/estimation/refined/search_box.hpp"
#include "framework/simulation/simulator.hpp"

namespace twinmap {

/// The misfit and its linear model at a point `at` (s, half-widths): with the whitened residual r and its
/// derivatives -J,
///   misfit(at + step) ~ misfit - 2 step' descent + step' (information + prior) step.
struct LocalMisfit {
  SampleStatus status;  ///< if not ok, the rest is empty
  Eigen::VectorXd at;
  double chi_square = 0.0;      ///< |r|^2
  double misfit = 0.0;          ///< chi_square + 3 |at|^2, the box as a normal distribution of its variance
  Eigen::Index residuals = 0;   ///< k
  Eigen::MatrixXd information;  ///< J'J, s x s
  Eigen::VectorXd descent;      ///< J'r - 3 at
  Eigen::VectorXd residual;     ///< r, k

  /// Degrees of freedom: residuals less the parameters that they, not the box, determine (trace of
  /// J'J (J'J + prior)^-1), at least one.
  double calcDegrees() const;

  Eigen::MatrixXd calcHessian() const;     ///< information + prior
  Eigen::MatrixXd calcCovariance() const;  ///< its inverse, in half-widths
};

/// A point with its linear model by central differences, and the misfits beside it.
struct ProbedMisfit {
  LocalMisfit local;
  Eigen::MatrixXd ways;     ///< s x s, orthogonal: how far the points beside it are from it
  Eigen::VectorXd misfits;  ///< 2 s: at + ways, then at - ways
};

/// How badly the simulator explains measured features, in units of their noise. One measurement, one thread.
class Misfit {
 public:
  /// measured: the experiment's features. Simulator, model and box must outlive the object.
  Misfit(Simulator& simulator, const RefinementModel& model, const SearchBox& box,
         const Eigen::VectorXd& measured);

  const SearchBox& getBox() const { return box_; }
  int getSimulations() const { return simulations_; }

  /// Looks at the features of a window alone from now on.
  void setWindow(const GrowingWindow& window);
  /// Takes the noise at the next point that is linearised, where it depends on the response; it stays until
  /// it is renewed, so that misfits can be compared.
  void renewNoise() { whitener_.reset(); }

  /// By exact derivatives where the simulator has them (simulateStencils).
  LocalMisfit linearize(const Eigen::VectorXd& at) { return linearizeAll(at).front(); }
  /// At all columns of `points` (s x n), simulated as one batch.
  std::vector<LocalMisfit> linearizeAll(const Eigen::MatrixXd& points);

  /// Whether four points are linearised about as fast as one: exact derivatives in lanes.
  bool linearizesTogether() const { return simulator_.hasDerivatives() && simulator_.getBatchSize() >= 4; }

  /// By the differences over `ways` (s x s, orthogonal columns) on both sides of `at`, where the window has a
  /// whitener: 2 s + 1 simulations, one batch.
  ProbedMisfit probe(const Eigen::VectorXd& at, const Eigen::MatrixXd& ways);

  /// The misfits at the columns of `points` (s x n), simulated as one batch; infinity where a simulation
  /// fails. After linearize().
  Eigen::VectorXd evaluate(const Eigen::MatrixXd& points);

 private:
  const NoiseWhitener& getWhitener() const;
  Eigen::MatrixXd simulateResiduals(const Eigen::MatrixXd& points, std::vector<SampleStatus>& statuses);
  Eigen::MatrixXd makePoints(const Eigen::MatrixXd& points) const;
  LocalMisfit makeLocalMisfit(const Eigen::VectorXd& at, const LocalModel& local);

  Simulator& simulator_;
  const RefinementModel& model_;
  const SearchBox& box_;
  const Eigen::VectorXd measured_;  // converted
  const GrowingWindow* window_;
  std::optional<NoiseWhitener> whitener_;  // where the noise depends on the response
  int simulations_ = 0;
};

}  // namespace twinmap
