#pragma once

#include <vector>

#include "framework/inference/inferrer.hpp"
#include "framework/results/run_summary.hpp"
#include "framework/study/pipeline/preparation/prepare_data.hpp"
#include "framework/study/pipeline/training/trained_map.hpp"

namespace twinmap {

/// Test samples that need a posterior on the simulator, and those of them for which it was sampled.
struct NeedingTests {
  std::vector<std::size_t> all, sampled;

  /// How many each that was sampled stands for.
  double calcWeight() const { return static_cast<double>(all.size()) / static_cast<double>(sampled.size()); }
};

/// What `twinmap infer` of a run makes of its test samples, and how that went.
struct InferredTests {
  Estimates by_estimator;                     ///< of all
  std::vector<Refined> refined;               ///< of all, or none where they are not refined
  std::vector<InferredMeasurement> inferred;  ///< likewise
  NeedingTests elsewhere;                     ///< whose refined estimate may lie elsewhere (mayBeElsewhere)
  NeedingTests near;                          ///< whose posterior a bound or its noise alone makes another
  StageNotes notes;

  std::size_t countNeeding() const { return elsewhere.all.size() + near.all.size(); }
  std::vector<std::size_t> listSampled() const;
};

/// How many of the test samples that need a posterior are sampled, evenly spread: so many that figures of
/// all, in which they stand for the others, are as sure as from `as_sure_as` samples.
std::size_t countSampled(std::size_t needing, std::size_t all, double as_sure_as);

/// Infers the test samples by the map and, where the experiment asks for refinement, refines each as `twinmap
/// infer` does a measurement, and samples the posterior on the simulator of those for which that would
/// (needsPosterior), or of some of them. Tells the trust model of the map what
/// intervals held. Throws Interrupted where `control` abandons the run. Cost: some 10 to 60 simulations each,
/// more where the first start is not accepted, and some 1000 or more a posterior.
InferredTests inferTestSamples(const Study& study, const PreparedData& data, TrainedMap& map);

}  // namespace twinmap
