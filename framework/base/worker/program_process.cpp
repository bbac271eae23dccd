#include "framework/base/worker/program_process.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <poll.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>

#include "framework/base/worker/process_guard.hpp"

namespace twinmap {
namespace {

/// Writing to a program that has ended must be an error of write() rather than the end of this process.
void ignoreBrokenPipes() {
  struct sigaction action {};
  sigaction(SIGPIPE, nullptr, &action);
  if (action.sa_handler == SIG_DFL) {
    signal(SIGPIPE, SIG_IGN);
  }
}

}  // namespace

ProgramProcess::ProgramProcess(const ProgramStart& start) {
  ignoreBrokenPipes();
  guard_ = ProcessGuard::getChannel();
  const StartedProgram started = startProgram(start, guard_);
  process_ = started.process;
  input_ = started.input;
  output_ = started.output;
  words_.open(started.messages);
}

ProgramProcess::~ProgramProcess() {
  end(nullptr);
  for (const int file : {input_, output_}) {
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
  const Deadline deadline(timeout);
  const std::string text = request + "\n";
  if (answered_) {
    words_.forget();  // those of the sample before
  }
  for (std::size_t sent = 0; sent < text.size();) {
    const ssize_t count = write(input_, text.data() + sent, text.size() - sent);
    if (count > 0) {
      sent += static_cast<std::size_t>(count);
    } else if (errno == EAGAIN || errno == EWOULDBLOCK) {
      wait(true, deadline);
    } else if (errno != EINTR) {
      fail();
    }
  }
  std::string line;
  while (!takeLine(line)) {
    wait(false, deadline);
  }
  answered_ = true;
  return line;
}

void ProgramProcess::wait(bool sending, const Deadline& deadline) {
  pollfd files[] = {{output_, POLLIN, 0}, {words_.getFile(), POLLIN, 0}, {sending ? input_ : -1, POLLOUT, 0}};
  const int ready = poll(files, 3, deadline.calcPollTime());
  if (ready > 0 && files[1].revents != 0) {
    words_.read();
  }
  if (ready > 0 && files[0].revents != 0) {
    readAnswer();
  }
  if (ready == 0 && deadline.isOver()) {
    words_.read();
    throw WorkerFailure(
        fmt::format("the program did not answer within {:g} s{}", deadline.getSeconds(), words_.describe()),
        true);
  }
}

void ProgramProcess::readAnswer() {
  constexpr std::size_t kMaxReceived = 1u << 30;  // a program that never ends its line
  char buffer[65536];
  const ssize_t count = read(output_, buffer, sizeof buffer);
  if (count > 0 && received_.size() < kMaxReceived) {
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
    words_.keep(line + "\n");
  }
  return false;
}

void ProgramProcess::fail() {
  // one that has closed its output is about to end by itself; what it says of that is the better reason
  constexpr int kTries = 100, kMicroseconds = 2000;
  siginfo_t info{};
  for (int i = 0; i < kTries && info.si_pid == 0; ++i) {
    words_.read();
    waitid(P_PID, static_cast<id_t>(process_), &info, WEXITED | WNOHANG | WNOWAIT);
    if (info.si_pid == 0) {
      usleep(kMicroseconds);
    }
  }
  int status = 0;
  const bool ended = info.si_pid != 0;
  end(&status);
  words_.read();
  keepRest();
  throw WorkerFailure(
      (ended ? describeEnd("the program", status) : std::string("the program closed its output")) +
      words_.describe());
}

/// What the program has written as answers and nobody has read: where there is none, the tail of its output.
void ProgramProcess::keepRest() {
  char buffer[65536];  // what a pipe holds; processes that outlive the program may go on writing
  const ssize_t count = read(output_, buffer, sizeof buffer);
  received_.append(buffer, static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
  received_ += '\n';
  for (std::string answer; takeLine(answer);) {
  }
}

double ProgramProcess::getResidentSize() const {
  std::ifstream file("/proc/" + std::to_string(process_) + "/statm");
  double total = 0.0, resident = 0.0;
  file >> total >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE));
}

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
