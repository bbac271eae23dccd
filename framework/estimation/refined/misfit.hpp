#pragma once

#include <functional>
#include <optional>

#include "framework/data/sensitivity/feature_sensitivities.hpp"
#include "framework/estimation/refined/measured_misfit.hpp"
#include "framework/estimation/refined/search_box.hpp"
#include "framework/experiment/points/prior.hpp"
#include "framework/simulation/simulator.hpp"

namespace twinmap {

/// A point with its linear model by central differences, and the misfits beside it.
struct ProbedMisfit {
  LocalMisfit local;
  Eigen::MatrixXd ways;     ///< s x s, orthogonal: how far the points beside it are from it
  Eigen::VectorXd misfits;  ///< 2 s: at + ways, then at - ways
};

/// Of measured features.
class Misfit final : public MeasuredMisfit {
 public:
  /// measured: the experiment's features. prior: of all unknown; null: uniform. All but these must outlive
  /// the object.
  Misfit(Simulator& simulator, const RefinementModel& model, const SearchBox& box,
         const Eigen::VectorXd& measured, const Prior* prior = nullptr);

  const SearchBox& getBox() const { return box_; }
  int getSimulations() const override { return simulations_; }

  /// Of samples whose noise is independent, of a simulator that can be cloned at fewer times.
  std::unique_ptr<MeasuredMisfit> makeThinned() const override;

  void setWindow(const GrowingWindow& window) override;
  /// Takes the noise at the next point that is linearised, where it depends on the response; it stays until
  /// it is renewed, so that misfits can be compared.
  void renewNoise() { whitener_.reset(); }

  /// By exact derivatives where the simulator has them (simulateStencils).
  LocalMisfit linearize(const Eigen::VectorXd& at) { return linearizeAll(at).front(); }
  /// At all columns of `points` (s x n), simulated in batches of kNumbersTogether.
  std::vector<LocalMisfit> linearizeAll(const Eigen::MatrixXd& points) override;

  /// Whether four points are linearised about as fast as one: exact derivatives in lanes.
  bool linearizesTogether() const { return simulator_.hasDerivatives() && simulator_.getBatchSize() >= 4; }

  /// By the differences over `ways` (s x s, orthogonal columns) on both sides of `at`, where the window has a
  /// whitener: 2 s + 1 simulations, one batch.
  ProbedMisfit probe(const Eigen::VectorXd& at, const Eigen::MatrixXd& ways);

  /// The misfits at the columns of `points` (s x n), simulated in such batches; infinity where a
  /// simulation fails. After linearize().
  Eigen::VectorXd evaluate(const Eigen::MatrixXd& points) override;

  Eigen::VectorXd sumUp(const Eigen::MatrixXd& points,
                        const std::function<Eigen::VectorXd(const Eigen::MatrixXd&)>& calcLosses) override;

 private:
  /// Whitened residuals (k x n) at the columns of `points` (s x n), simulated as one batch.
  Eigen::MatrixXd simulateResiduals(const Eigen::MatrixXd& points, std::vector<SampleStatus>& statuses);
  /// Points whose responses, so many each, are held together.
  Eigen::Index countTogether(int responses) const;
  void linearizeBatch(const Eigen::MatrixXd& points, int neighbours, std::vector<LocalMisfit>& all);
  const NoiseWhitener& getWhitener() const;
  PriorMisfit calcBeside(const Eigen::VectorXd& at) const;
  LocalMisfit combine(const SampleStatus& status, const Eigen::VectorXd& at, const Eigen::VectorXd& residual,
                      const Eigen::MatrixXd& jacobian) const;
  Eigen::VectorXd addPrior(Eigen::VectorXd chi_squares, const Eigen::MatrixXd& points) const;
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
