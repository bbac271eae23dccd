#include "framework/monitoring/stage_timer.hpp"

#include <fmt/core.h>

#include "framework/monitoring/log.hpp"

namespace twinmap {

void noteStage(const std::string& name, std::chrono::steady_clock::duration elapsed, StageNotes& notes) {
  const double seconds = std::chrono::duration<double>(elapsed).count();
  notes.times.push_back({name, seconds});
  logInfo(fmt::format("{}: {:.2f} s", name, seconds));
}

}  // namespace twinmap
