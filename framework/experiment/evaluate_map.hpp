#pragma once

#include "framework/experiment/labelled_sets.hpp"
#include "framework/experiment/run_experiment.hpp"
#include "framework/inverse_map/gp_map.hpp"
#include "framework/sensitivity/feature_sensitivities.hpp"
#include "framework/simulation/simulator.hpp"

namespace twinmap {

/// What the evaluation of a map looks at.
struct EvaluationContext {
  const ExperimentSpec& experiment;
  const std::vector<ParameterSpec>& unknown;  ///< collectUnknown
  const Simulator& simulator;
  const FeatureExtractor& extractor;
  const FeatureNoise& noise;
  const LabelledSets& samples;
  const GpMap& map;
  LocalModelSource local_models;
  int threads = 1;
};

/// Infers the test samples and finds out how good that is: errors and calibration, and, where the experiment
/// asks for them, information limit, exact posteriors and baselines. Results, warnings and times go to the
/// summary.
void evaluate(const EvaluationContext& context, RunSummary& run);

/// Whether a run of the experiment computes the information limit: where it asks for it and every feature has
/// noise.
bool hasInformationLimit(const ExperimentSpec& experiment, const LabelledFeatures& test);

/// Metrics, joint metrics and PIT counts of the summary, from its truth, predictions and limit.
void calcTestMetrics(const GpMap& map, RunSummary& run);

}  // namespace twinmap
