#include "framework/results/run_state.hpp"

#include <algorithm>

#include "framework/base/files/atomic_file.hpp"
#include "framework/experiment/files/experiment_file.hpp"
#include "framework/experiment/yaml/compare_trees.hpp"

namespace twinmap {
namespace {

namespace fs = std::filesystem;

constexpr const char* kResolved = "resolved.yaml";
constexpr const char* kStore = "store.txt";
constexpr const char* kLastFiles[] = {"provenance.json", "report.html"};

/// With the defaults of this version, so that a key that is new to it makes no difference, and without what
/// no result of a run depends on.
YamlNode normalize(const YamlNode& tree) {
  YamlNode normalized = parseYaml(writeIndependentDefaults(tree), kResolved);
  std::vector<YamlEntry>& entries = normalized.entries;
  entries.erase(std::remove_if(entries.begin(), entries.end(),
                               [](const YamlEntry& entry) { return entry.key == "measurement"; }),
                entries.end());
  return normalized;
}

}  // namespace

void noteStore(const fs::path& folder, const fs::path& given) {
  if (given.empty()) {
    fs::remove(folder / kStore);
  } else {
    writeTextFile(folder / kStore, fs::absolute(given).lexically_normal().string() + "\n");
  }
}

fs::path findStore(const fs::path& folder) {
  const fs::path whole = fs::absolute(folder / ".").lexically_normal().parent_path();
  if (fs::exists(whole / kStore)) {
    const std::string text = readBytes(whole / kStore);
    return text.substr(0, text.find('\n'));
  }
  const bool is_case = !fs::exists(whole / "chunks") && whole.parent_path().filename() == "cases";
  return is_case ? findStore(whole.parent_path().parent_path()) : whole / "chunks";
}

void requireSameExperiment(const fs::path& folder, const std::string& resolved) {
  const fs::path file = folder / kResolved;
  if (!fs::exists(file)) {
    return;
  }
  std::string listed;
  for (const KeyDifference& difference :
       compareTrees(normalize(loadYaml(file.string())), normalize(parseYaml(resolved, kResolved)))) {
    listed += "\n  " + difference.key + ": " + difference.before + " there, " + difference.after + " now";
  }
  if (!listed.empty()) {
    throw ExperimentError(folder.string() + ": holds the results of another experiment:" + listed +
                          "\nGive another folder with --out, or delete this one.");
  }
}

bool isComplete(const fs::path& folder) {
  return std::all_of(std::begin(kLastFiles), std::end(kLastFiles),
                     [&](const char* file) { return fs::exists(folder / file); });
}

void beginRun(const fs::path& folder, const std::string& resolved) {
  for (const char* file : kLastFiles) {
    fs::remove(folder / file);
  }
  writeTextFile(folder / kResolved, resolved);
}

}  // namespace twinmap
