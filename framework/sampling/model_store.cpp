#include "framework/sampling/model_store.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "framework/sampling/trajectory_content.hpp"
#include "framework/simulation/solver_revision.hpp"
#include "framework/spec/parameter_box.hpp"
#include "twinmap/build_info.hpp"

namespace twinmap {
namespace {

#if defined(__AVX512F__)
constexpr const char* kVectors = "AVX-512";
#elif defined(__AVX2__)
constexpr const char* kVectors = "AVX2";
#else
constexpr const char* kVectors = "SSE2";
#endif

}  // namespace

std::string writeStoreContent(const ModelSpec& model, const ResponseLayout& layout) {
  return writeTrajectoryContent(model, layout) +
         fmt::format("solver:\n  revision: {}\n  build: {}, {}, {} ({}), Simbody {}, Boost {}, Eigen {}\n",
                     kSolverRevision, kCompiler, kBuildType, kInstructionSet, kVectors, kSimbodyVersion,
                     kBoostVersion, kEigenVersion);
}

std::unique_ptr<TrajectoryStore> openStore(const ModelSpec& model, const ResponseLayout& layout,
                                           const std::filesystem::path& root) {
  auto store = std::make_unique<TrajectoryStore>(root, writeStoreContent(model, layout), countSampled(model),
                                                 layout.getRowCount());
  logSetAside(*store);
  return store;
}

void logSetAside(const TrajectoryStore& store) {
  for (const SetAsideChunk& chunk : store.getSetAside()) {
    spdlog::warn("{}: set aside: {}; its samples are simulated again", chunk.file.string(), chunk.reason);
  }
}

}  // namespace twinmap
