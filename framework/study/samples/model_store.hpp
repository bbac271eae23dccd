#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "framework/experiment/model/model_spec.hpp"
#include "framework/simulation/response_layout.hpp"
#include "framework/store/trajectory_store.hpp"

namespace twinmap {

enum class Portability {
  kThisBuild,
  kAnyProcessor,  ///< of samples with simulation.portable, which have the same bits in native and portable
                  ///< builds
};

/// The build of the program, and the C library's mathematics on this processor, as far as they can change a
/// bit of a sample: compiler, instruction set, Simbody, Boost, Eigen, glibc. Results that agree in it are
/// equal bit for bit.
std::string describeComputation(Portability portability = Portability::kThisBuild);

/// Names the samples of a TrajectoryStore: the model and the rows of its responses
/// (writeTrajectoryContent), the revision of the solver, and describeComputation().
std::string writeStoreContent(const ModelSpec& model, const ResponseLayout& layout);

/// Opens the store of a model's samples in the folder `root`, to read and write. Chunks that had to be set
/// aside are logged; so is where samples of the same model lie that another build computed, or another
/// machine's mathematics: they are not used.
std::unique_ptr<TrajectoryStore> openStore(const ModelSpec& model, const ResponseLayout& layout,
                                           const std::filesystem::path& root);

/// Warns in the log of chunks that could not be used, but for the first `known` of them.
void logSetAside(const TrajectoryStore& store, std::size_t known = 0);

}  // namespace twinmap
