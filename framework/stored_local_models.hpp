#pragma once

#include <filesystem>
#include <memory>

#include "framework/sensitivity/feature_sensitivities.hpp"
#include "framework/store/trajectory_store.hpp"

namespace twinmap {

/// The store of the neighbourhoods (NeighbourhoodSimulator) of a model's points, for derivatives to its
/// unknown parameters, in the folder `root`.
std::unique_ptr<TrajectoryStore> openNeighbourhoodStore(const ModelSpec& model, const Simulator& simulator,
                                                        const std::filesystem::path& root,
                                                        StoreAccess access = StoreAccess::kReadWrite);

/// As calcLocalModels, but a point whose neighbourhood the store has is not simulated again.
std::vector<LocalModel> calcStoredLocalModels(TrajectoryStore& store, const Simulator& simulator,
                                              const FeatureExtractor& extractor,
                                              const std::vector<ParameterSpec>& parameters,
                                              const Eigen::MatrixXd& points, int threads);

}  // namespace twinmap
