#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "framework/data/measurement/recording/available_response.hpp"
#include "framework/data/noise/feature_noise.hpp"
#include "framework/data/noise/stated_noise.hpp"
#include "framework/estimation/posterior/posterior_problem.hpp"
#include "framework/experiment/experiment_spec.hpp"
#include "framework/inference/posterior_estimate.hpp"
#include "framework/models/make_simulator.hpp"

namespace twinmap {

/// The simulator of an experiment with the features and the noise of its measurements; for one thread.
class MeasuredSimulator {
 public:
  /// Whether a run has checked the model by Simbody (makeTrustedSimulator), or this is to (makeSimulator).
  enum class Model { kTrusted, kToBeChecked };

  /// `experiment`: that of the run, with the excitation of the measurement where it is measured. stated: by
  /// the measurement (ResponseNoise::replace, FeatureNoise).
  MeasuredSimulator(const ExperimentSpec& experiment, const ResponseLayout& layout,
                    Model model = Model::kTrusted, const StatedNoise& stated = {});
  /// Of a simulator that was made elsewhere, of these times and unknown parameters.
  MeasuredSimulator(const ExperimentSpec& experiment, const ResponseLayout& layout,
                    std::unique_ptr<Simulator> simulator, const StatedNoise& stated = {});
  MeasuredSimulator(const MeasuredSimulator&) = delete;
  MeasuredSimulator& operator=(const MeasuredSimulator&) = delete;

  const Simulator& getSimulator() const { return *simulator_; }
  const FeatureExtractor& getExtractor() const { return extractor_; }
  const std::vector<ParameterSpec>& getUnknown() const { return getModel().getUnknown(); }

  /// Whether the experiment's `refine` asks for it (shouldRefine).
  bool isWanted() const { return wanted_; }

  /// Whether a posterior is a matter of some tenths of a second: exact derivatives, features that are linear
  /// in the response, noise on all of them.
  bool samplesFast() const;

  /// Throws ExperimentError, which says what to do, where a feature has no noise.
  void requireNoise() const;

  /// A measurement as a part of a problem: of all unknown parameters in their order. Features (d) that are
  /// NaN are missing and left out. It refers to this object, which simulates for it. Throws
  /// std::invalid_argument for a feature without noise.
  MeasuredTrial makeTrial(const Eigen::VectorXd& features, const Eigen::VectorXd& known) const;

  /// What the experiment and a measurement say of its noise: sizes that are unknown, features that a sensor's
  /// range cut off (their numbers are those of the experiment's features).
  NoiseHypothesis describeNoise(const std::vector<ClippedSample>& clipped) const;

  /// Why the simulation fails at the centre of the bounds and, where it does, at three more points of them;
  /// "" where one succeeds. known: q. Cost: one simulation where it succeeds.
  std::string findFailure(const Eigen::VectorXd& known) const;

 protected:
  const ModelSpec& getModelSpec() const { return model_; }
  const RefinementModel& getModel() const;
  const FeatureNoise& getNoise() const { return noise_; }
  Simulator& updSimulator() const { return *own_; }
  /// The outputs' names, and the sizes in their units.
  void nameNoise(std::vector<NoiseReport>& reports) const;

 private:
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
