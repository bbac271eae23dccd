#include "framework/base/log/log_context.hpp"

namespace twinmap {
namespace {

thread_local std::string prefix;

}  // namespace

LogContext::LogContext(std::string name) {
  prefix = std::move(name) + ": ";
}

LogContext::~LogContext() {
  prefix.clear();
}

const std::string& LogContext::getPrefix() {
  return prefix;
}

}  // namespace twinmap
