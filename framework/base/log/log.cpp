#include "framework/base/log/log.hpp"

#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/basic_file_sink.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <algorithm>

#include "framework/base/log/log_context.hpp"

namespace twinmap {
namespace {

class ContextFlag : public spdlog::custom_flag_formatter {
 public:
  void format(const spdlog::details::log_msg&, const std::tm&, spdlog::memory_buf_t& text) override {
    const std::string& prefix = LogContext::getPrefix();
    text.append(prefix.data(), prefix.data() + prefix.size());
  }
  std::unique_ptr<custom_flag_formatter> clone() const override { return std::make_unique<ContextFlag>(); }
};

/// A formatter whose pattern may use %* for the LogContext of the thread.
std::unique_ptr<spdlog::formatter> makeFormatter(const std::string& pattern) {
  auto formatter = std::make_unique<spdlog::pattern_formatter>();
  formatter->add_flag<ContextFlag>('*').set_pattern(pattern);
  return formatter;
}

}  // namespace

void logInfo(const std::string& text) {
  spdlog::info(text);
}
void logWarning(const std::string& text) {
  spdlog::warn(text);
}
void logError(const std::string& text) {
  spdlog::error(text);
}

void logToStderr(const std::string& before, bool in_colour) {
  auto sink = std::make_shared<spdlog::sinks::stderr_color_sink_mt>(in_colour ? spdlog::color_mode::automatic
                                                                              : spdlog::color_mode::never);
  sink->set_formatter(makeFormatter(before + "%^twinmap:%$ %*%v"));
  spdlog::set_default_logger(std::make_shared<spdlog::logger>("twinmap", sink));
}

void showWarningsOnly() {
  spdlog::default_logger()->sinks().front()->set_level(spdlog::level::warn);
}

void logToRunsOnly() {
  spdlog::set_default_logger(std::make_shared<spdlog::logger>("twinmap"));
}

void silenceLog() {
  spdlog::set_level(spdlog::level::off);
}

RunLog::RunLog(const std::filesystem::path& folder)
    : sink_(std::make_shared<spdlog::sinks::basic_file_sink_mt>((folder / "run.log").string())) {
  sink_->set_formatter(makeFormatter("%Y-%m-%d %H:%M:%S %l: %*%v"));
  spdlog::default_logger()->sinks().push_back(sink_);
}

RunLog::~RunLog() {
  sink_->flush();
  auto& sinks = spdlog::default_logger()->sinks();
  sinks.erase(std::remove(sinks.begin(), sinks.end(), sink_), sinks.end());
}

}  // namespace twinmap
