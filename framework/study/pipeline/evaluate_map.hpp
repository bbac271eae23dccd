#pragma once

#include "framework/base/log/run_control.hpp"
#include "framework/data/sensitivity/feature_sensitivities.hpp"
#include "framework/simulation/simulator.hpp"
#include "framework/study/pipeline/prepare_data.hpp"
#include "framework/study/pipeline/training/trained_map.hpp"

namespace twinmap {

/// What the evaluation of a map looks at.
struct EvaluationContext {
  const ExperimentSpec& experiment;
  const Simulator& simulator;
  const FeatureExtractor& extractor;
  const PreparedData& data;
  const TrainedMap& map;
  LocalModelSource local_models;
  const RunControl& control;
};

/// An evaluation, with the warnings and times of its stages.
struct MapEvaluation {
  Evaluation evaluation;
  StageNotes notes;
};

/// Infers the test samples as `twinmap infer` does, refined where the experiment asks for it, and finds out
/// how good that is: errors and calibration, and, where the experiment asks for them, information limit,
/// exact posteriors, calibration of posteriors and baselines.
MapEvaluation evaluateMap(const EvaluationContext& context);

}  // namespace twinmap
