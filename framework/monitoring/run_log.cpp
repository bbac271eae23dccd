#include "framework/monitoring/run_log.hpp"

#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/basic_file_sink.h>
#include <spdlog/spdlog.h>

#include <algorithm>

#include "framework/monitoring/log_context.hpp"

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

}  // namespace

std::unique_ptr<spdlog::formatter> makeLogFormatter(const std::string& pattern) {
  auto formatter = std::make_unique<spdlog::pattern_formatter>();
  formatter->add_flag<ContextFlag>('*').set_pattern(pattern);
  return formatter;
}

RunLog::RunLog(const std::filesystem::path& folder)
    : sink_(std::make_shared<spdlog::sinks::basic_file_sink_mt>((folder / "run.log").string())) {
  sink_->set_formatter(makeLogFormatter("%Y-%m-%d %H:%M:%S %l: %*%v"));
  spdlog::default_logger()->sinks().push_back(sink_);
}

RunLog::~RunLog() {
  sink_->flush();
  auto& sinks = spdlog::default_logger()->sinks();
  sinks.erase(std::remove(sinks.begin(), sinks.end(), sink_), sinks.end());
}

}  // namespace twinmap
