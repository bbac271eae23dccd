#pragma once

#include <filesystem>
#include <memory>

#include "framework/experiment/run_experiment.hpp"
#include "framework/sampling/sample_source.hpp"
#include "framework/sensitivity/feature_sensitivities.hpp"
#include "framework/store/trajectory_store.hpp"

namespace twinmap {

/// The store of the neighbourhoods (NeighbourhoodSimulator) of a model's points, for derivatives to its
/// unknown parameters, in the folder `root`; `layout` is that of one response.
std::unique_ptr<TrajectoryStore> openNeighbourhoodStore(const ModelSpec& model, const ResponseLayout& layout,
                                                        const std::filesystem::path& root,
                                                        StoreAccess access = StoreAccess::kReadWrite);

/// Simulates the neighbourhoods that the experiment needs (listNeededNeighbourhoods) and the source does not
/// have; times go to the summary. Throws Interrupted if the options ask to stop while some are missing.
void simulateNeighbourhoods(const ExperimentSpec& experiment, const SampleSource& source,
                            const RunOptions& options, RunSummary& run);

/// As calcLocalModels, but a point whose neighbourhood the source has is not simulated again. `layout` is the
/// extractor's, whose rows must be among those of the source.
std::vector<LocalModel> calcStoredLocalModels(const SampleSource& source, const ResponseLayout& layout,
                                              const FeatureExtractor& extractor,
                                              const std::vector<ParameterSpec>& parameters,
                                              const Eigen::MatrixXd& points, int threads);

}  // namespace twinmap
