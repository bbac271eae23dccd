#include "framework/monitoring/stage_timer.hpp"

#include <spdlog/spdlog.h>

namespace twinmap {

void noteStage(const std::string& name, std::chrono::steady_clock::duration elapsed, StageNotes& notes) {
  const double seconds = std::chrono::duration<double>(elapsed).count();
  notes.times.push_back({name, seconds});
  spdlog::info("{}: {:.2f} s", name, seconds);
}

}  // namespace twinmap
