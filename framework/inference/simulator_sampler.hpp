#pragma once

#include <optional>
#include <string>
#include <vector>

#include "framework/estimation/posterior/simulator_posterior.hpp"
#include "framework/estimation/ridges/identified_combinations.hpp"
#include "framework/inference/measured_simulator.hpp"
#include "framework/inference/posterior_estimate.hpp"

namespace twinmap {

/// Options for posteriors of an experiment's measurements. Throws ExperimentError for fewer draws than
/// kMinPosteriorDraws.
SimulatorPosteriorOptions makePosteriorOptions(const ExperimentSpec& experiment, int draws);

/// Options of a search that begins where others ended: so few starts of its own suffice.
SimulatorPosteriorOptions searchNearby(SimulatorPosteriorOptions options);

/// A measurement about a point: whitened residual (k) and minus its derivatives (k x u, in half-widths of the
/// bounds).
struct LinearizedMeasurement {
  Eigen::VectorXd residual;
  Eigen::MatrixXd jacobian;
  std::vector<Eigen::Index> features;     ///< of the rows, where they are not singular
  std::optional<NoiseWhitener> whitener;  ///< of these; none where their noise depends on the response
};

/// The posterior of a measurement, and the hypothesis of its noise that it is under.
struct SampledMeasurement {
  NoiseHypothesis noise;
  SimulatorPosterior posterior;  ///< of all unknown parameters
  PosteriorEstimate estimate;    ///< the same, as it is reported
};

/// Posteriors of measurements on the simulator of their experiment.
class SimulatorSampler : public MeasuredSimulator {
 public:
  using MeasuredSimulator::MeasuredSimulator;

  /// The posterior of all unknown parameters under a hypothesis of the noise (samplePosterior). given: points
  /// to search from as well (u x n). known: q. Throws std::invalid_argument for a feature without noise.
  SampledMeasurement sampleUnder(const NoiseHypothesis& noise, const Eigen::VectorXd& features,
                                 const Eigen::VectorXd& known, const Eigen::MatrixXd& given,
                                 const SimulatorPosteriorOptions& options) const;

  /// The same under the stated noise (describeNoise), searched first with a guess of sizes that are unknown.
  SampledMeasurement sampleAsStated(const Eigen::VectorXd& features, const Eigen::VectorXd& known,
                                    const NoiseHypothesis& stated, const Eigen::MatrixXd& given,
                                    const SimulatorPosteriorOptions& options) const;

  /// The same under the stated noise or, where that does not explain the measurement, under
  /// the first of other hypotheses that does (listNoiseHypotheses): a few samples left out, noise of another
  /// size, an offset, coloured noise. What is coloured and larger than stated may as well be physics that the
  /// model lacks, and more than one sample in twenty are not exceptions: then the stated one's it is. Cost:
  /// some more posteriors where the stated noise does not explain the measurement.
  SampledMeasurement samplePosterior(const Eigen::VectorXd& features, const Eigen::VectorXd& known,
                                     const NoiseHypothesis& stated, const Eigen::MatrixXd& given,
                                     const SimulatorPosteriorOptions& options) const;

  /// The second half of samplePosterior(): of one that the stated noise leaves unexplained, under another
  /// that explains it, if there is one.
  SampledMeasurement explainByNoise(SampledMeasurement sampled, const Eigen::VectorXd& features,
                                    const Eigen::VectorXd& known, const NoiseHypothesis& stated,
                                    const SimulatorPosteriorOptions& options) const;
  /// With the draws of a linear response where nothing explains the measurement.
  SimulatorPosteriorOptions spareMisfit(SimulatorPosteriorOptions options) const;

  /// The posterior of a trial alone as an estimate, its residual in the places of the features that are
  /// there.
  PosteriorEstimate makeEstimate(const MeasuredTrial& trial, SimulatorPosterior posterior) const;
  /// Of a measurement that nothing can be simulated for, because of `reason`.
  PosteriorEstimate makeFailed(const Eigen::VectorXd& features, const Eigen::VectorXd& known,
                               const std::string& reason) const;

  /// The ridges along which draws of a posterior lie or, where it is not reliable, the floors of its valleys;
  /// none where derivatives are not exact. Cost: 32 simulations with derivatives.
  std::vector<Ridge> findRidges(const PosteriorEstimate& posterior, const Eigen::VectorXd& known) const;

  /// A measurement (features, d, NaN where missing) about the best unknown parameters (u); none where they
  /// cannot be simulated. Cost: a simulation with derivatives.
  std::optional<LinearizedMeasurement> linearize(const Eigen::VectorXd& features,
                                                 const Eigen::VectorXd& known,
                                                 const Eigen::VectorXd& best) const;

  /// Few searches (twinmap::findLeastMisfit).
  LeastMisfit findLeastMisfit(const Eigen::VectorXd& features, const Eigen::VectorXd& known,
                              const Eigen::MatrixXd& given = {}) const;
  /// The least chi-square of the same, to compare gross misfits; in proportion where only some of `all`
  /// features are there, infinite where half are missing.
  double findLeastChiSquare(const Eigen::VectorXd& features, const Eigen::VectorXd& known,
                            Eigen::Index all) const;

 private:
  /// Whether rows are outputs of the model, which have sensors with faults, not what these are reduced to.
  bool readsOutputs() const;
  std::vector<NoiseHypothesis> listNoise(const NoiseHypothesis& stated, const Eigen::VectorXd& features,
                                         const Eigen::VectorXd& known, const Eigen::VectorXd& best) const;
  Eigen::MatrixXd listRidgePoints(const PosteriorEstimate& posterior) const;
};

}  // namespace twinmap
