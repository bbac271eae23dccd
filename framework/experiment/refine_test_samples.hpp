#pragma once

#include <vector>

#include "framework/experiment/prepare_data.hpp"
#include "framework/monitoring/run_control.hpp"
#include "framework/online/online_model.hpp"
#include "framework/refinement/refined.hpp"
#include "framework/results/run_summary.hpp"
#include "framework/simulation/simulator.hpp"

namespace twinmap {

/// What the refinement of test samples works with.
struct RefinementContext {
  const ExperimentSpec& experiment;
  const Simulator& simulator;
  const FeatureExtractor& extractor;
  const PreparedData& data;
  const OnlineModel* online;  ///< of the map; null for a map that has none: a surrogate
  const RunControl& control;
};

/// Refines every test sample as `twinmap infer` does a measurement, from the map's `answers`. Throws
/// Interrupted where `control` abandons the run. Cost: some 10 to 60 simulations each, more where the first
/// start is not accepted.
std::vector<Refined> refineTestSamples(const RefinementContext& context, const Predictions& answers);

/// The rows of methods.csv: the map (named as its key) on all test samples, and what of them was refined and
/// accepted.
std::vector<MethodSummary> compareMethods(const ExperimentSpec& experiment, const Evaluation& evaluation,
                                          const std::vector<Refined>& refined);

/// What refined test samples tell a trust model: how many were not explained, and how badly.
RefinementReference collectReference(const std::vector<Refined>& refined);

/// Where the experiment asks for it, refines the test samples and adds both methods to the evaluation; a
/// stage of its own.
StageNotes evaluateRefinement(const RefinementContext& context, Evaluation& evaluation);

}  // namespace twinmap
