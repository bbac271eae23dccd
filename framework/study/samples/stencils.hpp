#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "framework/base/log/run_control.hpp"
#include "framework/base/log/stage_timer.hpp"
#include "framework/data/sensitivity/feature_sensitivities.hpp"
#include "framework/experiment/experiment_spec.hpp"
#include "framework/study/samples/sample_source.hpp"

namespace twinmap {

/// The stage that simulates stencils (StencilSimulator), human-readable.
inline constexpr const char* kStencilStage = "simulate sensitivities";

/// Of how many training samples a selection by Fisher information looks at the sensitivities.
inline constexpr int kSensitivitySamples = 16;

/// Whether a step of the transform selects features by Fisher information.
bool selectsByFisherInformation(const ExperimentSpec& experiment);

/// The points at which a run of the experiment needs derivatives: the test points for the information limit,
/// and the first training points for a selection by Fisher information. Parameters x n, n = 0 if it needs
/// none. Those of samples that fail are not needed after all.
Eigen::MatrixXd listDerivativePoints(const ExperimentSpec& experiment);

/// Those of the points whose sample has not failed, as far as the store of the samples knows.
Eigen::MatrixXd dropFailed(const Eigen::MatrixXd& points, const TrajectoryStore& samples);

/// The store of the stencils of a model's points, for derivatives to its unknown parameters by a
/// simulator that has none of its own, in the folder `root`; `layout` is that of one response.
std::unique_ptr<TrajectoryStore> openStencilStore(const ModelSpec& model, const ResponseLayout& layout,
                                                  const std::filesystem::path& root,
                                                  StoreAccess access = StoreAccess::kReadWrite);

/// Simulates the stencils that the experiment needs and the source does not have; notes its time, if
/// anything was missing. Throws Interrupted if it is stopped while some are missing.
StageNotes simulateStencils(const ExperimentSpec& experiment, const SampleSource& source,
                            const RunControl& control);

/// The local models at points: by `simulator`, or from the source's stencils where it keeps them, of
/// which what it has is not simulated again. `simulator` and `extractor` are of the experiment; the rows of
/// its responses must be among those of the source. The result does not depend on `threads`.
std::vector<LocalModel> calcLocalModels(const ExperimentSpec& experiment, const SampleSource& source,
                                        const Simulator& simulator, const FeatureExtractor& extractor,
                                        const Eigen::MatrixXd& points, int threads);

}  // namespace twinmap
