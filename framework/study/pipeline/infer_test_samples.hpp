#pragma once

#include <vector>

#include "framework/inference/inferrer.hpp"
#include "framework/results/run_summary.hpp"
#include "framework/study/pipeline/preparation/prepare_data.hpp"
#include "framework/study/pipeline/training/trained_map.hpp"

namespace twinmap {

/// What `twinmap infer` of a run makes of its test samples, and how that went.
struct InferredTests {
  Estimates by_estimator;                     ///< of all
  std::vector<Refined> refined;               ///< of all, or none where they are not refined
  std::vector<InferredMeasurement> inferred;  ///< likewise
  /// Those for which it samples the posterior on the simulator, and those of them for which the run did.
  std::vector<std::size_t> needing, sampled;
  std::vector<bool> near;  ///< of `needing`: whether only a bound makes it another than the refined estimate
  StageNotes notes;

  bool areAllSampled() const { return sampled.size() == needing.size(); }
  /// How many of those that need it each that was sampled stands for.
  double calcWeight() const {
    return static_cast<double>(needing.size()) / static_cast<double>(sampled.size());
  }
};

/// How many of the test samples that need a posterior are sampled: so many that figures of all, in which they
/// stand for the others, are as sure as from 119 test samples (coverage to 2 %), and at least 3, for standard
/// errors.
std::size_t countSampled(std::size_t needing, std::size_t all);

/// Infers the test samples by the map and, where the experiment asks for refinement, refines each as `twinmap
/// infer` does a measurement, and samples the posterior on the simulator of those for which that would
/// (needsPosterior), or of countSampled() of them, evenly spread. Tells the trust model of the map what
/// intervals held. Throws Interrupted where `control` abandons the run. Cost: some 10 to 60 simulations each,
/// more where the first start is not accepted, and some 1000 or more a posterior.
InferredTests inferTestSamples(const Study& study, const PreparedData& data, TrainedMap& map);

}  // namespace twinmap
