#pragma once

#include "framework/study/pipeline/exact_posteriors.hpp"
#include "framework/study/pipeline/preparation/prepare_data.hpp"
#include "framework/study/pipeline/training/trained_map.hpp"

namespace twinmap {

/// A calibration of posteriors, with the warnings and times of its stage; none where there is nothing to
/// compute posteriors from, or too few of them are reliable.
struct CalibratedPosteriors {
  std::optional<PosteriorCalibration> calibration;
  StageNotes notes;
};

/// Ranks the true parameters of every test sample among draws of its posterior under the surrogate, as
/// `infer --posterior` samples it. The result does not depend on the number of threads. Cost: one posterior a
/// test sample. Throws Interrupted.
CalibratedPosteriors calibratePosteriors(const Study& study, const PreparedData& data, const TrainedMap& map);

/// The same of posteriors on the simulator (sampleTestPosteriors) of all columns of `test`.
CalibratedPosteriors calibratePosteriors(const Study& study, const LabelledFeatures& test,
                                         const std::vector<SimulatorPosterior>& posteriors);

}  // namespace twinmap
