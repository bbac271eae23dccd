#include "framework/base/worker/output_tail.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <cstring>

namespace twinmap {

OutputTail::~OutputTail() {
  if (file_ >= 0) {
    close(file_);
  }
}

void OutputTail::read() {
  char buffer[4096];
  ssize_t count = 0;
  while (file_ >= 0 && (count = ::read(file_, buffer, sizeof buffer)) > 0) {
    keep({buffer, static_cast<std::size_t>(count)});
  }
  if (count == 0 && file_ >= 0) {  // closed; poll would report it again and again
    close(file_);
    file_ = -1;
  }
}

void OutputTail::keep(const std::string& text) {
  constexpr std::size_t kMaxKept = 1000;  // characters: what people read of it
  text_ += text;
  if (text_.size() > kMaxKept) {
    text_.erase(0, text_.size() - kMaxKept);
  }
}

void OutputTail::forget() {
  read();
  text_.clear();
}

std::string OutputTail::describe() const {
  const std::size_t last = text_.find_last_not_of(" \n\r\t");
  return last == std::string::npos ? "" : "; it said: " + text_.substr(0, last + 1);
}

std::string describeEnd(const std::string& process, int status) {
  if (WIFSIGNALED(status)) {
    return process + " crashed: " + strsignal(WTERMSIG(status));
  }
  return process + " ended with exit code " + std::to_string(WEXITSTATUS(status));
}

}  // namespace twinmap
