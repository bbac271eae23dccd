#include "framework/study/shards/scheduler.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <map>
#include <sstream>
#include <stdexcept>

#include "framework/base/files/atomic_file.hpp"
#include "framework/base/json/json.hpp"
#include "framework/base/text/escape.hpp"

namespace twinmap {
namespace {

namespace fs = std::filesystem;

constexpr ShardKind kStages[] = {ShardKind::kSimulate, ShardKind::kCases, ShardKind::kFinish};
constexpr const char* kKindNames[] = {"slurm", "template", "local"};

struct CommandResult {
  int status = 0;
  std::string text;  ///< of both outputs
};

CommandResult runCommand(const std::string& command) {
  FILE* pipe = ::popen(("(" + command + ") 2>&1").c_str(), "r");
  if (pipe == nullptr) {
    throw std::runtime_error(command + ": cannot be started");
  }
  CommandResult result;
  std::array<char, 4096> piece{};
  while (const std::size_t size = std::fread(piece.data(), 1, piece.size(), pipe)) {
    result.text.append(piece.data(), size);
  }
  result.status = ::pclose(pipe);
  while (!result.text.empty() && std::isspace(static_cast<unsigned char>(result.text.back())) != 0) {
    result.text.pop_back();
  }
  return result;
}

/// The last line of what the command says: the job's number. Throws its words where it refuses.
std::string submitOne(const std::string& command) {
  const CommandResult result = runCommand(command);
  if (result.status != 0 || result.text.empty()) {
    throw std::runtime_error("the scheduler refused '" + command + "': " + result.text);
  }
  const std::string line = result.text.substr(result.text.rfind('\n') + 1);
  return line.substr(0, line.find(';'));  // Slurm names the cluster after the number
}

std::string join(const std::vector<std::string>& words, const std::string& separator) {
  std::string text;
  for (const std::string& word : words) {
    text += (text.empty() ? "" : separator) + word;
  }
  return text;
}

std::string replaceAll(std::string text, const std::map<std::string, std::string>& values) {
  for (const auto& [name, value] : values) {
    const std::string slot = "{" + name + "}";
    for (std::size_t at = text.find(slot); at != std::string::npos; at = text.find(slot, at + value.size())) {
      text.replace(at, slot.size(), value);
    }
  }
  return text;
}

std::string makeDirectives(const fs::path& folder, const ShardPlan& plan, const SubmitOptions& options) {
  constexpr double kMebi = 1024.0 * 1024.0, kMargin = 1.5;  // the estimate leaves out what libraries take
  const auto line = [](const std::string& option) { return "#SBATCH --" + option + "\n"; };
  std::string text =
      line("requeue") + line("open-mode=append") + line(fmt::format("signal=B:TERM@{}", options.grace)) +
      line("chdir=" + quoteForShell(folder.string())) + line("output=cluster/log/shard-%a.log") +
      line(fmt::format("time={}", options.minutes)) + line(fmt::format("cpus-per-task={}", options.threads)) +
      line(fmt::format("mem={}M", std::ceil(kMargin * plan.memory / kMebi)));
  text += options.partition.empty() ? "" : line("partition=" + options.partition);
  text += options.account.empty() ? "" : line("account=" + options.account);
  for (const std::string& option : options.sbatch) {
    text += line(option);
  }
  return text;
}

/// The shell passes SIGTERM on, waits until what is under way is saved, and queues the shard again, unless it
/// was cancelled. 143 is how a command that SIGTERM ended says so.
std::string makeSlurmBody(const fs::path& folder, const SubmitOptions& options) {
  return fmt::format(R"(folder={}
{} shard "$folder" "$SLURM_ARRAY_TASK_ID" --threads {} &
child=$!
trap 'kill -TERM "$child" 2>/dev/null' TERM
wait "$child"
code=$?
while kill -0 "$child" 2>/dev/null; do  # the signal, and not the end, was what it waited for
  wait "$child"
  code=$?
done
if [ "$code" -eq 143 ] && [ ! -e "$folder/cluster/cancelled" ]; then
  scontrol requeue "${{SLURM_ARRAY_JOB_ID}}_$SLURM_ARRAY_TASK_ID"
fi
exit "$code"
)",
                     quoteForShell(folder.string()), quoteForShell(options.program), options.threads);
}

std::string makePlainBody(const fs::path& folder, const SubmitOptions& options) {
  return fmt::format("exec {} shard {} \"${{SHARD:-$1}}\" --threads {}\n", quoteForShell(options.program),
                     quoteForShell(folder.string()), options.threads);
}

std::string submitSlurm(const fs::path& script, int first, int last, const std::string& after) {
  const std::string dependency = after.empty() ? "" : "--dependency=afterany:" + after + " ";
  return submitOne(fmt::format("sbatch --parsable --job-name=twinmap-{} --array={}-{} {}{}",
                               script.stem().string(), first, last, dependency,
                               quoteForShell(script.string())));
}

std::vector<std::string> submitByTemplate(const fs::path& script, int first, int last,
                                          const std::vector<std::string>& after,
                                          const SubmitOptions& options) {
  const std::string waiting = after.empty() ? "" : replaceAll(options.after, {{"jobs", join(after, ":")}});
  std::vector<std::string> ids;
  for (int shard = first; shard <= last; ++shard) {
    ids.push_back(submitOne(
        replaceAll(options.submit, {{"name", fmt::format("twinmap-{}-{}", script.stem().string(), shard)},
                                    {"after", waiting},
                                    {"shard", std::to_string(shard)},
                                    {"script", quoteForShell(script.string())}})));
  }
  return ids;
}

void writeJobs(const fs::path& folder, const SubmittedJobs& jobs) {
  const Json root = {{"on", kKindNames[static_cast<std::size_t>(jobs.kind)]}, {"jobs", jobs.ids}};
  writeTextFile(getClusterFolder(folder) / "jobs.json", formatJson(root, 1) + "\n");
}

SubmittedJobs readJobs(const fs::path& folder) {
  const fs::path file = getClusterFolder(folder) / "jobs.json";
  SubmittedJobs jobs;
  if (fs::exists(file)) {
    const Json root = parseJson(readBytes(file));
    jobs.ids = root.at("jobs").get<std::vector<std::string>>();
    jobs.kind = static_cast<SchedulerKind>(
        std::find(std::begin(kKindNames), std::end(kKindNames), root.at("on").get<std::string>()) -
        std::begin(kKindNames));
  }
  return jobs;
}

void submitStages(const fs::path& folder, const ShardPlan& plan, const std::vector<fs::path>& scripts,
                  const SubmitOptions& options, SubmittedJobs& jobs) {
  std::vector<std::string> after;
  int first = 0;
  for (const ShardKind stage : kStages) {
    const int count = plan.count(stage);
    if (count == 0) {
      continue;
    }
    const fs::path& script = scripts[static_cast<std::size_t>(stage)];
    const int last = first + count - 1;
    after = options.kind == SchedulerKind::kSlurm
                ? std::vector<std::string>{submitSlurm(script, first, last, join(after, ":"))}
                : submitByTemplate(script, first, last, after, options);
    jobs.ids.insert(jobs.ids.end(), after.begin(), after.end());
    writeJobs(folder, jobs);
    first = last + 1;
  }
}

/// "STATE" of each job and task that Slurm still has.
std::vector<std::string> askSlurm(const SubmittedJobs& jobs) {
  std::vector<std::string> states;
  for (const std::string& id : jobs.ids) {  // one by one: a forgotten number would fail them all
    const CommandResult result = runCommand("squeue --noheader --array --format=%T --jobs=" + id);
    std::istringstream lines(result.status == 0 ? result.text : "");
    for (std::string line; std::getline(lines, line);) {
      states.push_back(line);
    }
  }
  return states;
}

}  // namespace

void requireScheduler(SchedulerKind kind) {
  if (kind == SchedulerKind::kSlurm && runCommand("command -v sbatch").status != 0) {
    throw std::runtime_error(
        "sbatch was not found: --on slurm needs the commands of Slurm; --on template takes another "
        "scheduler, --on local prints the commands to run by any means");
  }
}

std::vector<fs::path> writeScripts(const fs::path& folder, const ShardPlan& plan,
                                   const SubmitOptions& options) {
  const fs::path absolute = fs::absolute(folder).lexically_normal();
  makeFolders(getClusterFolder(absolute) / "log");
  std::vector<fs::path> scripts;
  for (const ShardKind stage : kStages) {
    scripts.push_back(getClusterFolder(absolute) / (std::string(getName(stage)) + ".sh"));
    const bool slurm = options.kind == SchedulerKind::kSlurm;
    writeTextFile(scripts.back(),
                  "#!/bin/bash\n" + (slurm ? makeDirectives(absolute, plan, options) : "") +
                      (slurm ? makeSlurmBody(absolute, options) : makePlainBody(absolute, options)));
  }
  return scripts;
}

SubmittedJobs submitJobs(const fs::path& folder, const ShardPlan& plan, const SubmitOptions& options) {
  requireScheduler(options.kind);
  const std::vector<fs::path> scripts = writeScripts(folder, plan, options);
  SubmittedJobs jobs;
  jobs.kind = options.kind;
  writeJobs(folder, jobs);
  std::error_code ignored;
  fs::remove(getClusterFolder(folder) / "cancelled", ignored);
  if (options.kind == SchedulerKind::kLocal) {
    return jobs;
  }
  try {
    submitStages(folder, plan, scripts, options, jobs);
  } catch (const std::runtime_error&) {
    cancelJobs(folder);
    throw;
  }
  return jobs;
}

bool isQueued(const fs::path& folder) {
  const SubmittedJobs jobs = readJobs(folder);
  return jobs.kind == SchedulerKind::kSlurm && !askSlurm(jobs).empty();
}

std::string describeQueue(const fs::path& folder) {
  const SubmittedJobs jobs = readJobs(folder);
  if (jobs.kind != SchedulerKind::kSlurm) {
    return "";
  }
  std::map<std::string, int> count;
  for (const std::string& state : askSlurm(jobs)) {
    ++count[state];
  }
  std::string text;
  for (const auto& [state, number] : count) {
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", number, state);
  }
  return text.empty() ? "none queued or running" : text;
}

std::string cancelJobs(const fs::path& folder) {
  const SubmittedJobs jobs = readJobs(folder);
  if (jobs.ids.empty()) {
    return "nothing was submitted";
  }
  writeTextFile(getClusterFolder(folder) / "cancelled",
                "");  // before the signal: jobs do not queue themselves again
  if (jobs.kind != SchedulerKind::kSlurm) {
    return "cancel these jobs by the scheduler's own command: " + join(jobs.ids, " ");
  }
  const CommandResult result = runCommand("scancel " + join(jobs.ids, " "));
  if (result.status != 0) {
    throw std::runtime_error("scancel: " + result.text);
  }
  return "cancelled: " + join(jobs.ids, " ") + "; what is simulated is kept, and submit continues";
}

}  // namespace twinmap
