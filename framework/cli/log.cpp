#include "framework/cli/log.hpp"

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <cstdlib>

#include "framework/cli/progress_line.hpp"
#include "framework/monitoring/run_log.hpp"

namespace twinmap::cli {

void setUpLog() {
  const char* no_color = std::getenv("NO_COLOR");
  const bool plain = no_color != nullptr && no_color[0] != '\0';
  auto sink = std::make_shared<spdlog::sinks::stderr_color_sink_mt>(plain ? spdlog::color_mode::never
                                                                          : spdlog::color_mode::automatic);
  const std::string over_progress = isTerminal() ? "\r\x1b[K" : "";
  sink->set_formatter(makeLogFormatter(over_progress + "%^twinmap:%$ %*%v"));
  spdlog::set_default_logger(std::make_shared<spdlog::logger>("twinmap", sink));
}

void showWarningsOnly() {
  spdlog::default_logger()->sinks().front()->set_level(spdlog::level::warn);
}

}  // namespace twinmap::cli
