#pragma once

#include <memory>
#include <optional>

#include "framework/data/noise/feature_noise.hpp"
#include "framework/estimation/refined/refine.hpp"
#include "framework/inference/inferrer.hpp"
#include "framework/models/make_simulator.hpp"

namespace twinmap {

/// Refines inferences of one run on its simulator; for one thread.
class SimulatorRefiner {
 public:
  /// `experiment`: that of the run, with the excitation of the measurement where it is measured.
  SimulatorRefiner(const ExperimentSpec& experiment, const ResponseLayout& layout);
  SimulatorRefiner(const SimulatorRefiner&) = delete;
  SimulatorRefiner& operator=(const SimulatorRefiner&) = delete;

  const Simulator& getSimulator() const { return *simulator_; }
  const FeatureExtractor& getExtractor() const { return extractor_; }

  /// Whether the experiment's `refine` asks for it (shouldRefine).
  bool isWanted() const { return wanted_; }

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

  const ModelSpec model_;
  const FeatureExtractor extractor_;
  const std::unique_ptr<Simulator> simulator_;
  const FeatureNoise noise_;  // of extractor_
  const bool wanted_;
  const std::unique_ptr<Simulator> own_;           // a clone, which simulates
  mutable std::optional<RefinementModel> shared_;  // made when first used
};

}  // namespace twinmap
