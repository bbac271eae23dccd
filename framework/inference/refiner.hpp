#pragma once

#include <memory>

#include "framework/features/feature_noise.hpp"
#include "framework/inference/inferrer.hpp"
#include "framework/multibody/multibody_simulator.hpp"

namespace twinmap {

/// Refines inferences of one run on its simulator.
class SimulatorRefiner {
 public:
  /// `experiment`: that of the run, with the excitation of the measurement where it is measured.
  SimulatorRefiner(const ExperimentSpec& experiment, const ResponseLayout& layout);
  SimulatorRefiner(const SimulatorRefiner&) = delete;
  SimulatorRefiner& operator=(const SimulatorRefiner&) = delete;

  const MultibodySimulator& getSimulator() const { return simulator_; }
  const FeatureExtractor& getExtractor() const { return extractor_; }

  /// Searches all unknown parameters from the inferred ones and the nuisance parameters that explain the
  /// features best. known: q.
  Refined refine(const InferredMeasurement& inferred, const Eigen::VectorXd& features,
                 const Eigen::VectorXd& known) const;

  /// Searches the nuisance parameters alone, the others held at `point`; without nuisance parameters the
  /// point itself.
  Refined fitNuisance(const Eigen::VectorXd& point, const Eigen::VectorXd& features) const;

 private:
  const ModelSpec model_;
  const FeatureExtractor extractor_;
  const MultibodySimulator simulator_;
  const FeatureNoise noise_;  // of extractor_
};

/// A point of the sampled box: the given parameters, the nuisance parameters of `explanation` (a point of the
/// box, or empty: their centre), the known inputs.
Eigen::VectorXd makePoint(const ModelSpec& model, const Eigen::VectorXd& parameters,
                          const Eigen::VectorXd& explanation, const Eigen::VectorXd& known);

}  // namespace twinmap
