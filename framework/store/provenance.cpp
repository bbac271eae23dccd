#include "framework/store/provenance.hpp"

#include <sys/resource.h>
#include <sys/utsname.h>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <fstream>
#include <thread>
#include <twinmap/build_info.hpp>

#include "framework/base/files/digest.hpp"
#include "framework/base/json/json.hpp"

namespace twinmap {
namespace {

std::string makeDate() {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  std::tm utc{};
  gmtime_r(&now, &utc);
  char text[32];
  std::strftime(text, sizeof(text), "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text;
}

std::string readCpuModel() {
  std::ifstream file("/proc/cpuinfo");
  std::string line;
  while (std::getline(file, line)) {
    if (line.rfind("model name", 0) == 0) {
      return line.substr(line.find(':') + 2);
    }
  }
  return "unknown";
}

std::string readOperatingSystem() {
  utsname name{};
  return uname(&name) == 0 ? std::string(name.sysname) + " " + name.release + " " + name.machine : "unknown";
}

/// The largest resident set of this process so far.
double calcPeakMemoryMegabytes() {
  constexpr double kKilobytes = 1e-3 * 1.024;
  rusage usage{};
  return getrusage(RUSAGE_SELF, &usage) == 0 ? kKilobytes * static_cast<double>(usage.ru_maxrss) : 0.0;
}

}  // namespace

std::vector<std::pair<std::string, std::string>> calcDigests(const std::filesystem::path& folder) {
  std::vector<std::pair<std::string, std::string>> digests;
  for (const std::filesystem::directory_entry& entry : std::filesystem::directory_iterator(folder)) {
    const std::string kind = entry.path().extension().string();
    const std::string name = entry.path().filename().string();
    if (name == "resolved.yaml" || kind == ".h5" || kind == ".csv" || kind == ".md" || kind == ".tex") {
      digests.emplace_back(name, toHex(calcFileDigest(entry.path())));
    }
  }
  std::sort(digests.begin(), digests.end());
  return digests;
}

std::string findChangedFile(const std::string& provenance_json, const std::filesystem::path& folder) {
  const Json digests = parseJson(provenance_json).value("digests", Json::object());
  for (const auto& [name, digest] : digests.items()) {
    if (!std::filesystem::exists(folder / name)) {
      return name + " is missing";
    }
    if (toHex(calcFileDigest(folder / name)) != digest) {
      return name + " is not as it was written";
    }
  }
  return "";
}

std::vector<std::string> listBuildDifferences(const std::string& provenance_json) {
  const Json then = parseJson(provenance_json).flatten();
  const Json now = parseJson(makeProvenanceJson({})).flatten();
  std::vector<std::string> differences;
  for (const auto& [pointer, value] : now.items()) {
    const bool of_build = pointer == "/version" || pointer == "/machine/cpu" ||
                          pointer.rfind("/build/", 0) == 0 || pointer.rfind("/libraries/", 0) == 0;
    const Json before = then.value(pointer, Json("unknown"));
    if (of_build && before != value) {
      std::string name = pointer.substr(1);
      std::replace(name.begin(), name.end(), '/', '.');
      differences.push_back(name + ": " + formatJson(before) + " then, " + formatJson(value) + " now");
    }
  }
  return differences;
}

std::string makeProvenanceJson(const Provenance& provenance) {
  Json json;
  json["date"] = makeDate();
  json["command"] = provenance.command;
  json["version"] = kVersion;
  json["seed"] = provenance.seed;
  json["threads"] = provenance.threads;
  json["failed_samples"] = provenance.failed_samples;
  json["reused_samples"] = provenance.reused_samples;
  for (const auto& [stage, seconds] : provenance.stage_seconds) {
    json["seconds"][stage] = seconds;
  }
  json["online"] = {{"updates", provenance.online_updates},
                    {"median_us", provenance.online_median_us},
                    {"p99_us", provenance.online_p99_us}};
  json["peak_memory_mb"] = calcPeakMemoryMegabytes();
  json["warnings"] = provenance.warnings;
  for (const auto& [name, digest] : provenance.digests) {
    json["digests"][name] = digest;
  }
  json["build"] = {{"compiler", kCompiler}, {"type", kBuildType}, {"instruction_set", kInstructionSet}};
  json["libraries"] = {{"Eigen", kEigenVersion}, {"Simbody", kSimbodyVersion},  {"NLopt", kNloptVersion},
                       {"Boost", kBoostVersion}, {"yaml-cpp", kYamlCppVersion}, {"HDF5", kHdf5Version}};
  json["machine"] = {{"cpu", readCpuModel()},
                     {"cores", std::thread::hardware_concurrency()},
                     {"system", readOperatingSystem()}};
  constexpr int kIndent = 2;
  return formatJson(json, kIndent) + "\n";
}

}  // namespace twinmap
