#pragma once

#include <optional>
#include <string>

#include "framework/estimation/surrogate/posterior_sampler.hpp"
#include "framework/inference/inferrer.hpp"
#include "framework/inference/refiner.hpp"

namespace twinmap {

/// Infers one measurement after another by a run, refined or not; for one thread. The inferrer must outlive
/// it.
class MeasurementSession {
 public:
  /// `refine`: whether estimates are refined on the simulator; none: as the experiment's `refine` says.
  /// `posterior_draws`: of the posterior that each measurement is given as well; 0 for none. Throws
  /// ExperimentError where the simulator cannot be made, or the run has no surrogate for posteriors.
  MeasurementSession(const Inferrer& inferrer, std::optional<bool> refine, int posterior_draws = 0);

  bool refines() const { return refiner_.has_value(); }
  bool samplesPosteriors() const { return sampler_.has_value(); }

  /// The time in a file that is the model's 0: `start`, or that of the experiment's `measurement:`.
  double getStart(std::optional<double> start) const;

  /// known: the inputs of the set-up (q). Throws MeasurementError for a table that cannot be used
  /// (MeasurementReader::readFeatures). Cost: that of Inferrer::infer() (of a gross misfit 17 an output
  /// more),
  /// SimulatorRefiner::refineAndJudge() and PosteriorSampler::sample().
  InferredMeasurement infer(const Table& table, std::optional<double> start, const Eigen::VectorXd& known);

  /// The same from features (d, finite) that were extracted elsewhere.
  InferredMeasurement infer(const Eigen::VectorXd& features, const Eigen::VectorXd& known);

 private:
  /// explainByFault() of a measurement that is a model_mismatch.
  std::string findFault(const Eigen::VectorXd& response, const Eigen::VectorXd& known,
                        const InferredMeasurement& inferred);

  const Inferrer& inferrer_;
  Inferrer::Workspace workspace_;
  std::optional<SimulatorRefiner> refiner_;
  std::optional<PosteriorSampler> sampler_;
};

}  // namespace twinmap
