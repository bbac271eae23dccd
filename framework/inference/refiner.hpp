#pragma once

#include "framework/estimation/refined/refine.hpp"
#include "framework/inference/inferrer.hpp"
#include "framework/inference/simulator_sampler.hpp"

namespace twinmap {

/// The search that refines what a trained model inferred (makeRefinementTask). known: q.
RefinementTask makeTask(const ModelSpec& model, const TrustModel* trust, const InferredMeasurement& inferred,
                        const Eigen::VectorXd& features, const Eigen::VectorXd& known);

/// What the end of that search says: sets the refined estimate, not accepted where the estimator's has
/// several values, and the measurement's trust (judgeAnew). Its covariance and standard deviations are those
/// of the updating parameters.
void takeRefined(Refined refined, const TrustModel* trust, InferredMeasurement& inferred);

/// What an estimator inferred from a measurement, improved on the simulator: refined, or in the place of its
/// posterior; and what follows for the trust in it.
class SimulatorRefiner : public SimulatorSampler {
 public:
  using SimulatorSampler::SimulatorSampler;

  /// Searches all unknown parameters from what was inferred (makeTask, takeRefined). Throws
  /// std::invalid_argument for a feature without noise.
  void refineAndJudge(const Eigen::VectorXd& features, const Eigen::VectorXd& known, const TrustModel* trust,
                      InferredMeasurement& inferred) const;

  /// The posterior (samplePosterior), searched from all that is known of the measurement too: the estimator's
  /// basins, the training simulations of the most similar features, the refined estimate; and what follows
  /// for its trust (judgeAnew), which is withdrawn where the noise is not as stated: the simulated
  /// measurements that it compares with are then none like this one. Sets both.
  void sampleAndJudge(const Eigen::VectorXd& features, const Eigen::VectorXd& known, const TrustModel* trust,
                      const SimulatorPosteriorOptions& options, InferredMeasurement& inferred) const;

  /// Searches the nuisance parameters alone, the others held at `point`; without nuisance parameters the
  /// point itself, accepted.
  Refined fitNuisance(const Eigen::VectorXd& point, const Eigen::VectorXd& features) const;

 private:
  Eigen::MatrixXd listStarts(const InferredMeasurement& inferred, const Eigen::VectorXd& features,
                             const Eigen::VectorXd& known, const TrustModel* trust) const;
};

}  // namespace twinmap
