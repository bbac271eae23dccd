#pragma once

#include <functional>
#include <optional>

#include "framework/data/sensitivity/feature_sensitivities.hpp"
#include "framework/estimation/refined/refinement_model.hpp"
#include "framework/estimation/refined/search_box.hpp"
#include "framework/experiment/points/prior.hpp"
#include "framework/simulation/simulator.hpp"

namespace twinmap {

/// The misfit and its linear model at a point `at` (s, half-widths): with the whitened residual r and its
/// derivatives -J,
///   misfit(at + step) ~ misfit - 2 step' descent + step' (information + prior) step.
/// The prior is that of the box, as a normal distribution of its variance (3 |at|^2), but for parameters
/// whose distribution ends by itself (Prior::hasRange), and what else is known (BesideBounds).
struct LocalMisfit {
  SampleStatus status;  ///< if not ok, the rest is empty
  Eigen::VectorXd at;
  double chi_square = 0.0;      ///< |r|^2
  double misfit = 0.0;          ///< chi_square + that of the prior
  Eigen::Index residuals = 0;   ///< k
  Eigen::MatrixXd information;  ///< J'J, s x s
  Eigen::VectorXd descent;      ///< J'r and that of the prior
  Eigen::VectorXd residual;     ///< r, k
  Eigen::MatrixXd jacobian;     ///< J, k x s
  Eigen::VectorXd box{};        ///< s, information of the bounds; empty: 3 each
  PriorMisfit beside{};         ///< of the prior but for the bounds, in half-widths; sizes 0: uniform

  /// Degrees of freedom: residuals less the parameters that they, not the box, determine (trace of
  /// J'J (J'J + prior)^-1), at least one.
  double calcDegrees() const;

  Eigen::MatrixXd calcHessian() const;  ///< information + prior
  /// The same without the bounds, where these are taken into account by themselves.
  double calcMisfitWithin() const { return chi_square + beside.misfit; }
  Eigen::VectorXd calcDescentWithin() const;
  Eigen::MatrixXd calcInformationWithin() const;
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
  /// measured: the experiment's features. prior: of all unknown; null: uniform. All but these must outlive
  /// the object.
  Misfit(Simulator& simulator, const RefinementModel& model, const SearchBox& box,
         const Eigen::VectorXd& measured, const Prior* prior = nullptr);

  const SearchBox& getBox() const { return box_; }
  int getSimulations() const { return simulations_; }

  /// Looks at the features of a window alone from now on.
  void setWindow(const GrowingWindow& window);
  /// Takes the noise at the next point that is linearised, where it depends on the response; it stays until
  /// it is renewed, so that misfits can be compared.
  void renewNoise() { whitener_.reset(); }

  /// By exact derivatives where the simulator has them (simulateStencils).
  LocalMisfit linearize(const Eigen::VectorXd& at) { return linearizeAll(at).front(); }
  /// At all columns of `points` (s x n), simulated in batches of at most 256 MiB.
  std::vector<LocalMisfit> linearizeAll(const Eigen::MatrixXd& points);

  /// Whether four points are linearised about as fast as one: exact derivatives in lanes.
  bool linearizesTogether() const { return simulator_.hasDerivatives() && simulator_.getBatchSize() >= 4; }

  /// By the differences over `ways` (s x s, orthogonal columns) on both sides of `at`, where the window has a
  /// whitener: 2 s + 1 simulations, one batch.
  ProbedMisfit probe(const Eigen::VectorXd& at, const Eigen::MatrixXd& ways);

  /// Whitened residuals (k x n) at the columns of `points` (s x n), simulated as one batch. After
  /// linearize().
  Eigen::MatrixXd simulateResiduals(const Eigen::MatrixXd& points, std::vector<SampleStatus>& statuses);

  /// The misfits at the columns of `points` (s x n), simulated in batches of at most 256 MiB; infinity where
  /// a simulation fails. After linearize().
  Eigen::VectorXd evaluate(const Eigen::MatrixXd& points);

  /// The same of other losses, of whitened residuals (k x n), without the prior.
  Eigen::VectorXd sumUp(const Eigen::MatrixXd& points,
                        const std::function<Eigen::VectorXd(const Eigen::MatrixXd&)>& calcLosses);

 private:
  /// Points whose responses, so many each, are held together.
  Eigen::Index countTogether(int responses) const;
  void linearizeBatch(const Eigen::MatrixXd& points, int neighbours, std::vector<LocalMisfit>& all);
  const NoiseWhitener& getWhitener() const;
  PriorMisfit calcBeside(const Eigen::VectorXd& at) const;
  LocalMisfit combine(const SampleStatus& status, const Eigen::VectorXd& at, const Eigen::VectorXd& residual,
                      const Eigen::MatrixXd& jacobian) const;
  Eigen::VectorXd addPrior(Eigen::VectorXd chi_squares, const Eigen::MatrixXd& points) const;
  Eigen::MatrixXd makePoints(const Eigen::MatrixXd& points) const;
  LocalMisfit makeLocalMisfit(const Eigen::VectorXd& at, const LocalModel& local);

  Simulator& simulator_;
  const RefinementModel& model_;
  const SearchBox& box_;
  const Eigen::VectorXd measured_;   // converted
  const Prior* prior_;               // null: uniform
  Eigen::VectorXd box_information_;  // s
  const GrowingWindow* window_;
  std::optional<NoiseWhitener> whitener_;  // where the noise depends on the response
  int simulations_ = 0;
};

}  // namespace twinmap
