#include "framework/monitoring/stage_timer.hpp"

#include <spdlog/spdlog.h>

namespace twinmap {

void noteStage(const std::string& name, std::chrono::steady_clock::duration elapsed,
               std::vector<StageTime>& times) {
  const double seconds = std::chrono::duration<double>(elapsed).count();
  times.push_back({name, seconds});
  spdlog::info("{}: {:.2f} s", name, seconds);
}

}  // namespace twinmap
