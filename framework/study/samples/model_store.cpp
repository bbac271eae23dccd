#include "framework/study/samples/model_store.hpp"

#include <fmt/core.h>
#include <gnu/libc-version.h>

#include "framework/base/files/atomic_file.hpp"
#include "framework/base/log/log.hpp"
#include "framework/base/log/notice.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/simulation/solver_revision.hpp"
#include "framework/study/samples/trajectory_content.hpp"
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

constexpr const char* kSolverKey = "solver:\n";

/// The C library chooses its sine and exponential by the processor.
std::string describeMathematics() {
  return fmt::format("glibc {}{}", ::gnu_get_libc_version(), __builtin_cpu_supports("fma") ? ", FMA" : "");
}

std::string takeModel(const std::string& content) {
  return content.substr(0, content.find(kSolverKey));
}

/// Where others have computed the same model with something else.
void warnAboutOtherBuilds(const TrajectoryStore& store, const std::string& content) {
  for (const auto& entry : std::filesystem::directory_iterator(store.getFolder().parent_path())) {
    const std::filesystem::path file = entry.path() / "content.yaml";
    std::error_code ignored;
    if (entry.path() == store.getFolder() || !std::filesystem::exists(file, ignored)) {
      continue;
    }
    const std::string other = readBytes(file);
    if (other != content && takeModel(other) == takeModel(content) &&
        other.find("stencils:\n") == std::string::npos) {
      logWarning(describeNotice(Notice::kOtherBuild, entry.path().string()));
    }
  }
}

}  // namespace

std::string describeComputation(Portability portability) {
  const std::string processor = portability == Portability::kAnyProcessor
                                    ? "portable (x86-64-v3)"
                                    : fmt::format("{} ({})", kInstructionSet, kVectors);
  return fmt::format("{}, {}, {}, Simbody {}, Boost {}, Eigen {}, {}", kCompiler, kBuildType, processor,
                     kSimbodyVersion, kBoostVersion, kEigenVersion, describeMathematics());
}

std::string writeStoreContent(const ModelSpec& model, const ResponseLayout& layout) {
  const auto portability = model.simulation.portable ? Portability::kAnyProcessor : Portability::kThisBuild;
  return writeTrajectoryContent(model, layout) + kSolverKey +
         fmt::format("  revision: {}\n  build: {}\n", kSolverRevision, describeComputation(portability));
}

std::unique_ptr<TrajectoryStore> openStore(const ModelSpec& model, const ResponseLayout& layout,
                                           const std::filesystem::path& root) {
  const std::string content = writeStoreContent(model, layout);
  auto store = std::make_unique<TrajectoryStore>(root, content, countSampled(model), layout.getRowCount());
  logSetAside(*store);
  if (store->getSampleCount() == 0) {
    warnAboutOtherBuilds(*store, content);
  }
  return store;
}

void logSetAside(const TrajectoryStore& store, std::size_t known) {
  const std::vector<SetAsideChunk>& chunks = store.getSetAside();
  for (std::size_t i = known; i < chunks.size(); ++i) {
    logWarning(describeNotice(Notice::kSetAside, chunks[i].file.string(), chunks[i].reason));
  }
}

}  // namespace twinmap
