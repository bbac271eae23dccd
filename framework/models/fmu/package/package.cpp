#include "framework/models/fmu/package/package.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <stdlib.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <mutex>
#include <stdexcept>

#include "framework/base/text/nearest_name.hpp"
#include "framework/base/text/source_location.hpp"
#include "framework/models/fmu/package/archive.hpp"
#include "framework/models/fmu/package/compile_sources.hpp"

namespace twinmap::fmi {

namespace fs = std::filesystem;

/// A folder below the system's folder for temporary files (TMPDIR) that is removed when this process ends, in
/// whatever way: a small process in a session of its own waits for that end, by a pipe that closes with it,
/// and removes the folder. Throws std::runtime_error if it cannot be made.
class GuardedFolder {
 public:
  GuardedFolder();
  GuardedFolder(const GuardedFolder&) = delete;
  GuardedFolder& operator=(const GuardedFolder&) = delete;
  /// Waits until the folder is gone.
  ~GuardedFolder();

  const std::filesystem::path& getPath() const { return path_; }

 private:
  void startGuard();

  std::filesystem::path path_;
  int pipe_ = -1;  ///< writing end: its closing is the sign
  pid_t guard_ = -1;
};

namespace {
/// Reads until the pipe is closed, whatever signals come, and removes its folder.
constexpr const char* kGuardScript = R"(trap '' HUP INT TERM QUIT; cd /; read -r line; exec rm -rf -- "$1")";
}  // namespace

GuardedFolder::GuardedFolder() {
  std::string pattern = (std::filesystem::temp_directory_path() / "twinmap-fmu.XXXXXX").string();
  if (mkdtemp(pattern.data()) == nullptr) {
    throw std::runtime_error(pattern + ": cannot be made: " + std::strerror(errno));
  }
  path_ = pattern;
  startGuard();
}

void GuardedFolder::startGuard() {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) {
    std::filesystem::remove_all(path_);
    throw std::runtime_error(std::string("no pipe can be made: ") + std::strerror(errno));
  }
  pipe_ = ends[1];
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_adddup2(&files, ends[0], STDIN_FILENO);
  posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addopen(&files, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes,
                           POSIX_SPAWN_SETSID);  // no signal of the terminal or the group reaches it
  std::string script = kGuardScript, path = path_.string(), shell = "sh", option = "-c",
              name = "twinmap-guard";
  char* arguments[] = {shell.data(), option.data(), script.data(), name.data(), path.data(), nullptr};
  const int error = posix_spawn(&guard_, "/bin/sh", &files, &attributes, arguments, environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&files);
  close(ends[0]);
  if (error != 0) {
    close(pipe_);
    std::filesystem::remove_all(path_);
    throw std::runtime_error(std::string("/bin/sh cannot be started: ") + std::strerror(error));
  }
}

GuardedFolder::~GuardedFolder() {
  close(pipe_);
  while (waitpid(guard_, nullptr, 0) < 0 && errno == EINTR) {
  }
}

struct Package::Content {
  std::string file;
  GuardedFolder folder{};
  ArchiveContent archive{};
  ModelDescription description{};
  std::mutex compiling{};
};

std::vector<std::string> listOwnPlatforms() {
#if defined(__aarch64__)
  return {"aarch64-linux", "linux-aarch64"};
#else
  return {"x86_64-linux", "linux64"};
#endif
}

Package::Package(const std::string& file) : content_(new Content{file}) {
  content_->archive = unpackArchive(file, getFolder(), listOwnPlatforms());
  const fs::path xml = getFolder() / "modelDescription.xml";
  if (!fs::is_regular_file(xml)) {
    throw ExperimentError(file + ": is not an FMU: it has no modelDescription.xml");
  }
  content_->description = readModelDescription(xml, file);
  fs::create_directories(getFolder() / "resources");  // named to the FMU whether it has one or not
}

const std::string& Package::getFile() const {
  return content_->file;
}

const ModelDescription& Package::getDescription() const {
  return content_->description;
}

const fs::path& Package::getFolder() const {
  return content_->folder.getPath();
}

Kind Package::chooseKind(std::optional<Kind> asked) const {
  const ModelDescription& description = getDescription();
  const Kind kind = asked.value_or(description.co_simulation ? Kind::kCoSimulation : Kind::kModelExchange);
  const bool has = kind == Kind::kCoSimulation ? description.co_simulation.has_value()
                                               : description.model_exchange.has_value();
  if (!has) {
    throw ExperimentError(getFile() + ": the FMU offers no " + toText(kind) + ", only " +
                          toText(description.co_simulation ? Kind::kCoSimulation : Kind::kModelExchange));
  }
  const Variable* clock = description.findTimedClock();
  if (kind == Kind::kModelExchange && clock != nullptr) {
    throw ExperimentError(getFile() + ": its clock '" + clock->name +
                          "' has to be ticked at times, which is not supported in Model Exchange");
  }
  return kind;
}

fs::path Package::requireLibrary(Kind kind) const {
  const Capabilities& can = getDescription().getCapabilities(kind);
  for (const std::string& platform : listOwnPlatforms()) {
    const fs::path library = getFolder() / "binaries" / platform / (can.model_identifier + ".so");
    if (fs::is_regular_file(library)) {
      return library;
    }
  }
  const std::lock_guard<std::mutex> guard(content_->compiling);
  const fs::path compiled = getFolder() / (can.model_identifier + ".so");
  if (fs::is_regular_file(compiled)) {
    return compiled;
  }
  if (!fs::is_directory(getFolder() / "sources")) {
    const std::vector<std::string>& platforms = content_->archive.platforms;
    throw ExperimentError(getFile() + ": has no library for this platform, binaries/" +
                          listOwnPlatforms().front() + " or " + listOwnPlatforms().back() + "/" +
                          can.model_identifier + ".so" +
                          (platforms.empty() ? ", and no sources" : "; there are: " + listNames(platforms)));
  }
  if (!compileSources({getFile(), getFolder() / "sources", can, getDescription().version}, compiled)) {
    throw ExperimentError(getFile() +
                          ": has no library for this platform, and its sources need a C compiler: '" +
                          getCompiler() + "' cannot be started");
  }
  return compiled;
}

}  // namespace twinmap::fmi
