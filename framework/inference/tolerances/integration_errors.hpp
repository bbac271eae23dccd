#pragma once

#include <optional>
#include <vector>

#include "framework/data/features/feature_extractor.hpp"
#include "framework/data/noise/feature_noise.hpp"
#include "framework/data/noise/noise_whitener.hpp"
#include "framework/data/sensitivity/integration_error.hpp"
#include "framework/experiment/experiment_spec.hpp"
#include "framework/simulation/simulator.hpp"

namespace twinmap {

/// The errors of an experiment's integration at 16 points of its box, for one tolerance after another. The
/// points are the same whatever the seed, so that experiments which differ in it share their simulations.
class IntegrationErrors {
 public:
  /// `experiment` must outlive the object.
  explicit IntegrationErrors(const ExperimentSpec& experiment);

  /// At the tolerances of `simulation`, against a hundredth of them. None where half of the points fail,
  /// where the simulator has no tighter tolerances or a feature no noise. Cost: 32 simulations; 16 more with
  /// derivatives the first time that the error is not far below the noise.
  std::optional<IntegrationError> calc(const SimulationSpec& simulation);

  /// What another model of the same parameters and outputs changes, both at these tolerances, likewise.
  std::optional<IntegrationError> calcChange(const SimulationSpec& simulation, ModelSpec other);

 private:
  std::optional<IntegrationError> compare(const Simulator& simulator, const Simulator& other);
  /// Of the features in their linear form, where they have one: known without sampling.
  const FeatureNoise& getNoise() const { return noise_.getLinearForm(); }
  const FeatureExtractor& getExtractor() const { return getNoise().getExtractor(); }
  void whiten(const Eigen::MatrixXd& responses);
  const NoiseWhitener* findWhitener(std::size_t point) const;
  void linearize(const Simulator& simulator);

  const ExperimentSpec& experiment_;
  const ResponseLayout layout_;
  const FeatureExtractor extractor_;
  const FeatureNoise noise_;
  const Eigen::MatrixXd points_;
  std::vector<std::optional<NoiseWhitener>> whiteners_;  // of each point, or one of all; none where it failed
  std::vector<Eigen::MatrixXd> sensitivities_;           // of each point, whitened; empty where it failed
};

}  // namespace twinmap
