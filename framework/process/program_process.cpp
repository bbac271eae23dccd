#include "framework/process/program_process.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>
#include <fstream>

#include "framework/process/process_guard.hpp"
#include "framework/process/start_program.hpp"

namespace twinmap {
namespace {

double getTime() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Writing to a program that has ended must be an error of write() rather than the end of this process.
void ignoreBrokenPipes() {
  struct sigaction action {};
  sigaction(SIGPIPE, nullptr, &action);
  if (action.sa_handler == SIG_DFL) {
    signal(SIGPIPE, SIG_IGN);
  }
}

std::string describeEnd(int status) {
  if (WIFSIGNALED(status)) {
    return "the program crashed: " + std::string(strsignal(WTERMSIG(status)));
  }
  return "the program ended with exit code " + std::to_string(WEXITSTATUS(status));
}

}  // namespace

ProgramProcess::ProgramProcess(const ProgramStart& start) {
  ignoreBrokenPipes();
  guard_ = ProcessGuard::getChannel();
  const StartedProgram started = startProgram(start, guard_);
  process_ = started.process;
  input_ = started.input;
  output_ = started.output;
  messages_ = started.messages;
}

ProgramProcess::~ProgramProcess() {
  end(nullptr);
  for (const int file : {input_, output_, messages_}) {
    if (file >= 0) {
      close(file);
    }
  }
}

void ProgramProcess::end(int* status) {
  if (process_ > 0) {
    kill(-process_, SIGKILL);  // also what it has started
    releaseGroup(guard_, process_);
    while (waitpid(process_, status, 0) < 0 && errno == EINTR) {
    }
    process_ = -1;
  }
}

std::string ProgramProcess::exchange(const std::string& request, double timeout) {
  const double deadline = getTime() + timeout;
  const std::string text = request + "\n";
  readMessages();
  last_words_.clear();  // of the sample before
  for (std::size_t sent = 0; sent < text.size();) {
    const ssize_t count = write(input_, text.data() + sent, text.size() - sent);
    if (count > 0) {
      sent += static_cast<std::size_t>(count);
    } else if (errno == EAGAIN || errno == EWOULDBLOCK) {
      wait(true, deadline, timeout);
    } else if (errno != EINTR) {
      fail();
    }
  }
  std::string line;
  while (!takeLine(line)) {
    wait(false, deadline, timeout);
  }
  return line;
}

void ProgramProcess::wait(bool sending, double deadline, double timeout) {
  pollfd files[] = {{output_, POLLIN, 0}, {messages_, POLLIN, 0}, {sending ? input_ : -1, POLLOUT, 0}};
  constexpr double kLongest = 1e9;  // ms; what an int holds
  const double left = std::clamp(1000.0 * (deadline - getTime()), 0.0, kLongest);
  const int ready = poll(files, 3, static_cast<int>(std::ceil(left)));
  if (ready > 0 && files[1].revents != 0) {
    readMessages();
  }
  if (ready > 0 && files[0].revents != 0) {
    readAnswer();
  }
  if (ready == 0 && getTime() >= deadline) {
    readMessages();
    throw WorkerFailure(
        "the program did not answer within " + fmt::format("{:g} s", timeout) + describeMessages(), true);
  }
}

void ProgramProcess::readAnswer() {
  constexpr std::size_t kMostReceived = 1u << 30;  // a program that never ends its line
  char buffer[65536];
  const ssize_t count = read(output_, buffer, sizeof buffer);
  if (count > 0 && received_.size() < kMostReceived) {
    received_.append(buffer, static_cast<std::size_t>(count));
  } else if (count >= 0 || (errno != EAGAIN && errno != EINTR)) {
    fail();
  }
}

bool ProgramProcess::takeLine(std::string& line) {
  for (std::size_t end = 0; (end = received_.find('\n')) != std::string::npos;) {
    line = received_.substr(0, end);
    received_.erase(0, end + 1);
    if (!line.empty() && line.front() == '{') {
      return true;
    }
    keepMessage(line + "\n");
  }
  return false;
}

void ProgramProcess::keepMessage(const std::string& text) {
  constexpr std::size_t kMostKept = 1000;  // characters: what people read of it
  last_words_ += text;
  if (last_words_.size() > kMostKept) {
    last_words_.erase(0, last_words_.size() - kMostKept);
  }
}

void ProgramProcess::readMessages() {
  char buffer[4096];
  ssize_t count = 0;
  while (messages_ >= 0 && (count = read(messages_, buffer, sizeof buffer)) > 0) {
    keepMessage({buffer, static_cast<std::size_t>(count)});
  }
  if (count == 0 && messages_ >= 0) {  // closed; poll would report it again and again
    close(messages_);
    messages_ = -1;
  }
}

std::string ProgramProcess::describeMessages() {
  const std::size_t last = last_words_.find_last_not_of(" \n\r\t");
  return last == std::string::npos ? "" : "; it said: " + last_words_.substr(0, last + 1);
}

void ProgramProcess::fail() {
  // one that has closed its output is about to end by itself; what it says of that is the better reason
  constexpr int kTries = 100, kMicroseconds = 2000;
  siginfo_t info{};
  for (int i = 0; i < kTries && info.si_pid == 0; ++i) {
    readMessages();
    waitid(P_PID, static_cast<id_t>(process_), &info, WEXITED | WNOHANG | WNOWAIT);
    if (info.si_pid == 0) {
      usleep(kMicroseconds);
    }
  }
  int status = 0;
  const bool ended = info.si_pid != 0;
  end(&status);
  readMessages();
  throw WorkerFailure((ended ? describeEnd(status) : std::string("the program closed its output")) +
                      describeMessages());
}

double ProgramProcess::getResidentSize() const {
  std::ifstream file("/proc/" + std::to_string(process_) + "/statm");
  double total = 0.0, resident = 0.0;
  file >> total >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE));
}

}  // namespace twinmap
