#include "framework/base/log/stage_timer.hpp"

#include <fmt/core.h>

namespace twinmap {

void noteStage(const std::string& name, std::chrono::steady_clock::duration elapsed, StageNotes& notes) {
  const double seconds = std::chrono::duration<double>(elapsed).count();
  notes.times.push_back({name, seconds});
  logInfo(fmt::format("{}: {:.2f} s", name, seconds));
}

}  // namespace twinmap
