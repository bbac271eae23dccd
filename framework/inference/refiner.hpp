#pragma once

#include <memory>
#include <optional>

#include "framework/data/noise/feature_noise.hpp"
#include "framework/data/noise/stated_noise.hpp"
#include "framework/estimation/refined/refine.hpp"
#include "framework/inference/inferrer.hpp"
#include "framework/models/make_simulator.hpp"

namespace twinmap {

/// Options for posteriors of an experiment's measurements. Throws ExperimentError for fewer draws than
/// kMinPosteriorDraws.
SimulatorPosteriorOptions makePosteriorOptions(const ExperimentSpec& experiment, int draws);

/// What is inferred on the simulator of an experiment: estimates refined, posteriors; for one thread.
class SimulatorRefiner {
 public:
  /// Whether a run has checked the model by Simbody (makeTrustedSimulator), or this is to (makeSimulator).
  enum class Model { kTrusted, kToBeChecked };

  /// `experiment`: that of the run, with the excitation of the measurement where it is measured. stated: by
  /// the measurement (ResponseNoise::replace, FeatureNoise).
  SimulatorRefiner(const ExperimentSpec& experiment, const ResponseLayout& layout,
                   Model model = Model::kTrusted, const StatedNoise& stated = {});
  /// Of a simulator that was made elsewhere, of these times and unknown parameters.
  SimulatorRefiner(const ExperimentSpec& experiment, const ResponseLayout& layout,
                   std::unique_ptr<Simulator> simulator, const StatedNoise& stated = {});
  SimulatorRefiner(const SimulatorRefiner&) = delete;
  SimulatorRefiner& operator=(const SimulatorRefiner&) = delete;

  const Simulator& getSimulator() const { return *simulator_; }
  const FeatureExtractor& getExtractor() const { return extractor_; }

  /// Whether the experiment's `refine` asks for it (shouldRefine).
  bool isWanted() const { return wanted_; }

  /// Whether a posterior is a matter of some tenths of a second: exact derivatives, features that are linear
  /// in the response, noise on all of them.
  bool samplesFast() const;

  /// Throws ExperimentError, which says what to do, where a feature has no noise.
  void requireNoise() const;

  const std::vector<ParameterSpec>& getUnknown() const { return getModel().getUnknown(); }

  /// A measurement as a part of a problem: of all unknown parameters in their order. Features (d) that are
  /// NaN are missing and left out. It refers to this object, which simulates for it. Throws
  /// std::invalid_argument for a feature without noise.
  MeasuredTrial makeTrial(const Eigen::VectorXd& features, const Eigen::VectorXd& known) const;

  /// What the experiment and a measurement say of its noise: sizes that are unknown, features that a sensor's
  /// range cut off (their numbers are those of the experiment's features).
  NoiseHypothesis describeNoise(const std::vector<ClippedSample>& clipped) const;

  /// The ridges along which draws of a posterior lie or, where it is not reliable, the floors of its valleys;
  /// none where derivatives are not exact. Cost: 32 simulations with derivatives.
  std::vector<Ridge> findRidges(const PosteriorEstimate& posterior, const Eigen::VectorXd& known) const;

  /// The posterior of a trial alone as an estimate, its residual in the places of the features that are
  /// there.
  PosteriorEstimate makeEstimate(const MeasuredTrial& trial, SimulatorPosterior posterior) const;

  /// The posterior of all unknown parameters under a hypothesis of the noise (samplePosterior). given: points
  /// to search from as well (u x n). known: q. Throws std::invalid_argument for a feature without noise.
  PosteriorEstimate sampleUnder(const NoiseHypothesis& noise, const Eigen::VectorXd& features,
                                const Eigen::VectorXd& known, const Eigen::MatrixXd& given,
                                const SimulatorPosteriorOptions& options) const;

  /// The same under the stated noise (describeNoise) or, where that does not explain the measurement, under
  /// the first of other hypotheses that does (listNoiseHypotheses): a few samples left out, noise of another
  /// size, an offset, coloured noise. What is coloured and larger than stated may as well be physics that the
  /// model lacks, and more than one sample in twenty are not exceptions: then the stated one's it is. Cost:
  /// some more posteriors where the stated noise does not explain the measurement.
  PosteriorEstimate samplePosterior(const Eigen::VectorXd& features, const Eigen::VectorXd& known,
                                    const NoiseHypothesis& stated, const Eigen::MatrixXd& given,
                                    const SimulatorPosteriorOptions& options) const;

  /// Why the simulation fails at the centre of the bounds and, where it does, at three more points of them;
  /// "" where one succeeds. known: q. Cost: one simulation where it succeeds.
  std::string findFailure(const Eigen::VectorXd& known) const;
  /// Of a measurement that nothing can be simulated for, because of `reason`.
  PosteriorEstimate makeFailed(const Eigen::VectorXd& features, const Eigen::VectorXd& known,
                               const std::string& reason) const;

  /// The least chi-square of few searches (twinmap::findLeastChiSquare), to compare gross misfits; in
  /// proportion where only some of `all` features are there, infinite where half are missing.
  double findLeastChiSquare(const Eigen::VectorXd& features, const Eigen::VectorXd& known,
                            Eigen::Index all) const;

  /// The posterior (samplePosterior), searched from all that is known of the measurement too: the estimator's
  /// basins, the training simulations of the most similar features, the refined estimate; and what follows
  /// for its trust (judgeAnew), which is withdrawn where the noise is not as stated: the simulated
  /// measurements that it compares with are then none like this one. Sets both.
  void sampleAndJudge(const Eigen::VectorXd& features, const Eigen::VectorXd& known, const TrustModel* trust,
                      const SimulatorPosteriorOptions& options, InferredMeasurement& inferred) const;

  /// Searches all unknown parameters from what was inferred (makeRefinementTask). known: q. The covariance
  /// and the standard deviations are those of the updating parameters. Throws std::invalid_argument for a
  /// feature without noise.
  Refined refine(const InferredMeasurement& inferred, const Eigen::VectorXd& features,
                 const Eigen::VectorXd& known, const TrustModel* trust) const;

  /// refine(), and what follows for the measurement's trust (judgeAnew): sets both.
  void refineAndJudge(const Eigen::VectorXd& features, const Eigen::VectorXd& known, const TrustModel* trust,
                      InferredMeasurement& inferred) const;

  /// Searches the nuisance parameters alone, the others held at `point`; without nuisance parameters the
  /// point itself, accepted.
  Refined fitNuisance(const Eigen::VectorXd& point, const Eigen::VectorXd& features) const;

 private:
  const RefinementModel& getModel() const;
  Eigen::MatrixXd listRidgePoints(const PosteriorEstimate& posterior) const;
  RefinementTask makeTask(const InferredMeasurement& inferred, const Eigen::VectorXd& features,
                          const Eigen::VectorXd& known, const TrustModel* trust) const;
  Eigen::MatrixXd listStarts(const InferredMeasurement& inferred, const Eigen::VectorXd& features,
                             const Eigen::VectorXd& known, const TrustModel* trust) const;

  /// Whether rows are outputs of the model, which have sensors with faults, not what these are reduced to.
  bool readsOutputs() const;
  void nameNoise(SimulatorFit& fit) const;
  std::vector<NoiseHypothesis> listNoise(const NoiseHypothesis& stated, const Eigen::VectorXd& features,
                                         const Eigen::VectorXd& known, const Eigen::VectorXd& best) const;

  const ModelSpec model_;
  const std::vector<OutputNoiseSpec> output_noise_;
  const double noise_scale_;
  const FeatureExtractor extractor_;
  const std::unique_ptr<Simulator> simulator_;
  const FeatureNoise noise_;  // of extractor_
  const NoiseHypothesis stated_noise_;
  const bool wanted_;
  const std::unique_ptr<Simulator> own_;           // a clone, which simulates
  mutable std::optional<RefinementModel> shared_;  // made when first used
};

}  // namespace twinmap
