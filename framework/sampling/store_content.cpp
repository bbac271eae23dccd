#include "framework/sampling/store_content.hpp"

#include <fmt/format.h>

#include "framework/sampling/trajectory_content.hpp"
#include "framework/simulation/solver_revision.hpp"
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

}  // namespace twinmap
