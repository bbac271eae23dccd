#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "framework/data/reduction/feature_transform.hpp"
#include "kernels/gp/model.hpp"

namespace twinmap {

/// What a map makes of its features (nothing, a surrogate or a network), without the matrices that predict:
/// small also for many samples.
struct MapSummary {
  std::vector<std::string> feature_names;
  FeatureTransform transform;
  std::vector<gp::ModelStructure> structures;        ///< one per parameter
  std::vector<gp::Hyperparameters> hyperparameters;  ///< one per parameter
};

/// Reads the summary alone. Throws std::runtime_error for a file that is not a maps.h5.
MapSummary readMapSummary(const std::filesystem::path& path);

}  // namespace twinmap
