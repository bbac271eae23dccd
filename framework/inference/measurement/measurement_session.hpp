#pragma once

#include <memory>
#include <optional>
#include <tuple>

#include "framework/estimation/surrogate/posterior/posterior_sampler.hpp"
#include "framework/inference/measurement/measurement_inference.hpp"
#include "framework/inference/refiner.hpp"

namespace twinmap {

class DirectInference;

/// How measurements are inferred.
struct SessionOptions {
  /// Whether estimates are refined on the simulator; none: as the experiment's `refine` says.
  std::optional<bool> refine{};
  /// Of the posterior that each measurement is given; 0: only where nothing less will do.
  int posterior_draws = 0;
  /// Whose posterior; none: the simulator's where it takes tenths of a second
  /// (SimulatorRefiner::samplesFast), else the surrogate's.
  std::optional<PosteriorSource> posterior_from{};
  /// Whether posteriors on the simulator come with profile likelihoods.
  bool profiles = false;

  friend bool operator<(const SessionOptions& a, const SessionOptions& b) {
    return std::tie(a.refine, a.posterior_draws, a.posterior_from, a.profiles) <
           std::tie(b.refine, b.posterior_draws, b.posterior_from, b.profiles);
  }
};

/// Infers one measurement after another by a run, refined or not. The inferrer must outlive it.
///
/// Where estimates are refined, the simulator is fast and the surrogate's posterior was not asked for, its
/// own takes the place of the refined estimate where least squares may mislead (needsPosterior), and a
/// recording that lacks samples or would be interpolated is inferred by the simulator alone
/// (DirectInference), as from the experiment file.
class MeasurementSession final : public MeasurementInference {
 public:
  /// Throws ExperimentError where the simulator cannot be made, or the posterior that is asked for cannot be
  /// had.
  MeasurementSession(const Inferrer& inferrer, const SessionOptions& options);
  ~MeasurementSession() override;

  const MeasurementReader& getReader() const override { return inferrer_.getReader(); }
  bool refines() const override { return refines_; }
  bool samplesPosteriors() const override { return sampler_.has_value() || samples_always_; }
  MissingCells getMissingCells() const override {
    return samplesByNeed() || getReader().findReduction() != nullptr ? MissingCells::kKeep
                                                                     : MissingCells::kRefuse;
  }

  InferredMeasurement infer(const Table& table, std::optional<double> start,
                            const Eigen::VectorXd& known) override;
  /// Cost: that of Inferrer::infer() (of a table with a gross misfit 17 an output more),
  /// SimulatorRefiner::refineAndJudge(), sampleAndJudge() and PosteriorSampler::sample().
  InferredMeasurement infer(const Eigen::VectorXd& features, const Eigen::VectorXd& known) override;

 private:
  DirectInference& getDirect();
  void choosePosterior(const SessionOptions& options);
  /// Whether the simulator may be asked for a posterior that replaces what the estimator cannot give.
  bool samplesByNeed() const { return samples_where_needed_ || samples_always_; }
  /// explainByFault() of a measurement that is a model_mismatch.
  std::string findFault(const Eigen::VectorXd& response, const Eigen::VectorXd& known,
                        const InferredMeasurement& inferred) override;

  const Inferrer& inferrer_;
  OnlineWorkspace workspace_;
  std::optional<SimulatorRefiner> simulator_;  // where it may be asked
  std::optional<PosteriorSampler> sampler_;    // where the surrogate's posterior was asked for
  std::string doubt_;                          // PosteriorEstimate::doubt of what it samples
  std::unique_ptr<DirectInference> direct_;    // made for the first recording that lacks samples
  SimulatorPosteriorOptions posterior_options_;
  bool refines_ = false;
  bool samples_always_ = false, samples_where_needed_ = false;  // posteriors on the simulator
};

}  // namespace twinmap
