#include "framework/base/worker/start_program.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "framework/base/worker/process_guard.hpp"
#include "framework/base/worker/worker_process.hpp"

namespace twinmap {
namespace {

/// A pipe whose ends no other program inherits, above the numbers that a program gets.
class Pipe {
 public:
  Pipe() {
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) {
      throw WorkerFailure(std::string("no pipe can be made: ") + std::strerror(errno));
    }
    constexpr int kFirst = 10;
    for (int i = 0; i < 2; ++i) {
      ends_[i] = fcntl(ends[i], F_DUPFD_CLOEXEC, kFirst);
      close(ends[i]);
    }
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  ~Pipe() {
    for (const int end : ends_) {
      if (end >= 0) {
        close(end);
      }
    }
  }

  int getReading() const { return ends_[0]; }
  int getWriting() const { return ends_[1]; }
  int takeReading() { return std::exchange(ends_[0], -1); }
  int takeWriting() { return std::exchange(ends_[1], -1); }
  void closeWriting() { close(takeWriting()); }

 private:
  int ends_[2];
};

/// Texts as exec takes them.
class TextArray {
 public:
  explicit TextArray(std::vector<std::string> texts) : texts_(std::move(texts)) {
    for (std::string& text : texts_) {
      pointers_.push_back(text.data());
    }
    pointers_.push_back(nullptr);
  }
  char* const* get() { return pointers_.data(); }

 private:
  std::vector<std::string> texts_;
  std::vector<char*> pointers_;
};

std::vector<std::string> mergeEnvironment(const ProgramStart& start) {
  std::vector<std::string> merged;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string text = *entry;
    const std::string name = text.substr(0, text.find('='));
    const bool replaced = std::any_of(start.environment.begin(), start.environment.end(),
                                      [&](const auto& own) { return own.first == name; });
    if (!replaced) {
      merged.push_back(text);
    }
  }
  for (const auto& [name, value] : start.environment) {
    merged.push_back(name + "=" + value);
  }
  return merged;
}

void setLimits(double memory) {
  constexpr double kGibibyte = 1024.0 * 1024.0 * 1024.0, kMax = 1e18;
  const rlimit no_core{0, 0};  // a crash is expected and leaves no file
  setrlimit(RLIMIT_CORE, &no_core);
  if (memory > 0.0) {
    const auto bytes = static_cast<rlim_t>(std::min(memory * kGibibyte, kMax));
    const rlimit limit{bytes, bytes};
    setrlimit(RLIMIT_AS, &limit);
  }
}

/// What the new process does; async-signal-safe. Returns where something failed, with errno.
void become(const ProgramStart& start, const int (&files)[3], int guard, char* const* arguments,
            char* const* environment) {
  setpgid(0, 0);
  if (!guardGroup(guard, getpid())) {
    return;
  }
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  for (const int number : {SIGPIPE, SIGINT, SIGTERM, SIGHUP}) {
    signal(number, SIG_DFL);
  }
  for (int i = 0; i < 3; ++i) {
    dup2(files[i], i);
  }
  if (!start.folder.empty() && chdir(start.folder.c_str()) != 0) {
    return;
  }
  setLimits(start.memory);
  close_range(STDERR_FILENO + 1, ~0U, CLOSE_RANGE_CLOEXEC);
  execvpe(arguments[0], arguments, environment);
}

/// Whether the program runs: the pipe closes when it begins, and says errno where it cannot.
int readError(Pipe& errors) {
  errors.closeWriting();
  int error = 0;
  while (read(errors.getReading(), &error, sizeof error) < 0 && errno == EINTR) {
  }
  return error;
}

}  // namespace

StartedProgram startProgram(const ProgramStart& start, int guard) {
  TextArray arguments(start.command), environment(mergeEnvironment(start));
  Pipe input, output, messages, errors;
  const int files[3] = {input.getReading(), output.getWriting(), messages.getWriting()};
  const pid_t process = fork();
  if (process == 0) {
    become(start, files, guard, arguments.get(), environment.get());
    const int error = errno;
    [[maybe_unused]] const ssize_t written = write(errors.getWriting(), &error, sizeof error);
    _exit(127);
  }
  const int error = process < 0 ? errno : readError(errors);
  if (error != 0) {
    if (process > 0) {
      releaseGroup(guard, process);
      waitpid(process, nullptr, 0);
    }
    throw WorkerFailure(start.command.front() + " cannot be started: " + std::strerror(error));
  }
  StartedProgram started{process, input.takeWriting(), output.takeReading(), messages.takeReading()};
  for (const int file : {started.input, started.output, started.messages}) {
    fcntl(file, F_SETFL, O_NONBLOCK);
  }
  return started;
}

}  // namespace twinmap
