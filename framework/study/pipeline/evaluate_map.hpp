#pragma once

#include "framework/study/pipeline/preparation/prepare_data.hpp"
#include "framework/study/pipeline/training/trained_map.hpp"

namespace twinmap {

/// An evaluation, with the warnings and times of its stages.
struct MapEvaluation {
  Evaluation evaluation;
  StageNotes notes;
};

/// Infers the test samples as `twinmap infer` does, refined where the experiment asks for it, or sampled
/// where that does (inferTestSamples), and finds out how good that is: errors and calibration, and, where the
/// experiment asks for them, information limit, exact posteriors, calibration of posteriors and baselines.
MapEvaluation evaluateMap(const Study& study, const PreparedData& data, TrainedMap& map);

/// An evaluation without a map.
struct PosteriorEvaluation {
  MapEvaluation evaluated;
  OnlineTimes times;  ///< of a measurement, on one of the threads
};

/// The same of the exact posterior of each test sample, as `twinmap infer FILE.yaml` gives it. What is not
/// reliable is left out of the samples of `data`, with a warning. Throws std::runtime_error where fewer than
/// three are reliable.
PosteriorEvaluation evaluatePosteriors(const Study& study, PreparedData& data);

}  // namespace twinmap
