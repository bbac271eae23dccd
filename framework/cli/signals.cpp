#include "framework/cli/signals.hpp"

#include <unistd.h>

#include <csignal>
#include <string_view>

namespace twinmap::cli {
namespace {

constexpr int kExitOfSignal = 128;

std::atomic<bool> stop{false}, abandon{false};
std::atomic<int> number{0};
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int>::is_always_lock_free);

/// Only what is safe in a signal handler.
void handle(int signal) {
  if (number.exchange(signal) != 0) {
    ::_exit(kExitOfSignal + signal);
  }
  abandon = signal == SIGTERM;
  stop = true;
  constexpr std::string_view kMessage =
      "\ntwinmap: stopping: what is under way is finished and kept; once more to stop at once\n";
  [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, kMessage.data(), kMessage.size());
}

void note(int signal) {
  if (number.exchange(signal) != 0) {
    ::_exit(kExitOfSignal + signal);
  }
}

void install(void (*handler)(int)) {
  for (const int signal : {SIGINT, SIGTERM}) {
    struct sigaction action {};
    action.sa_handler = handler;
    action.sa_flags = SA_RESTART;
    ::sigaction(signal, &action, nullptr);
  }
}

}  // namespace

StopFlags catchSignals() {
  install(&handle);
  return {stop, abandon};
}

void watchInterrupt(bool watched) {
  install(watched ? &note : SIG_DFL);
}

int getSignal() {
  return number;
}

}  // namespace twinmap::cli
