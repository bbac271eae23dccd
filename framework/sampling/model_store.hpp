#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "framework/response/response_layout.hpp"
#include "framework/spec/model_spec.hpp"
#include "framework/store/trajectory_store.hpp"

namespace twinmap {

/// Names the samples of a TrajectoryStore: the model and the rows of its responses
/// (writeTrajectoryContent), and the build of the program as far as it can change a bit of them: revision of
/// the solver, compiler, instruction set, Simbody, Boost and Eigen.
std::string writeStoreContent(const ModelSpec& model, const ResponseLayout& layout);

/// Opens the store of a model's samples in the folder `root`, to read and write. Chunks that had to be set
/// aside are logged. Throws std::runtime_error if another process has the store.
std::unique_ptr<TrajectoryStore> openStore(const ModelSpec& model, const ResponseLayout& layout,
                                           const std::filesystem::path& root);

/// Warns in the log of chunks that could not be used.
void logSetAside(const TrajectoryStore& store);

}  // namespace twinmap
