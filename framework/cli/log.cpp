#include "framework/cli/log.hpp"

#include <cstdlib>

#include "framework/base/log/log.hpp"
#include "framework/cli/progress_line.hpp"

namespace twinmap::cli {

void setUpLog() {
  const char* no_color = std::getenv("NO_COLOR");
  const bool plain = no_color != nullptr && no_color[0] != '\0';
  const std::string over_progress = isTerminal() ? "\r\x1b[K" : "";
  logToStderr(over_progress, !plain);
}

}  // namespace twinmap::cli
