#include "framework/store/finished_run.hpp"

#include <algorithm>

#include "framework/base/text/source_location.hpp"

namespace twinmap {

namespace fs = std::filesystem;

void requireFinishedRun(const fs::path& folder, const std::vector<std::string>& files) {
  const auto require = [&](bool condition, const std::string& problem) {
    if (!condition) {
      throw ExperimentError(folder.string() + ": " + problem);
    }
  };
  require(fs::is_directory(folder), "there is no such folder");
  const std::vector<fs::path> cases = listCases(folder);
  require(cases.empty(), "is the folder of a sweep; name one of its cases, such as " +
                             (cases.empty() ? "" : cases[0].string()));
  require(fs::exists(folder / "resolved.yaml"), "is not a folder of a run: it has no resolved.yaml");
  require(fs::exists(folder / "provenance.json"), "the run in it is not finished: it has no provenance.json");
  for (const std::string& file : files) {
    require(fs::exists(folder / file), "has no " + file);
  }
}

std::vector<fs::path> listCases(const fs::path& folder) {
  std::vector<fs::path> cases;
  if (fs::is_directory(folder / "cases")) {
    for (const fs::directory_entry& entry : fs::directory_iterator(folder / "cases")) {
      if (entry.is_directory()) {
        cases.push_back(entry.path());
      }
    }
  }
  std::sort(cases.begin(), cases.end());
  return cases;
}

}  // namespace twinmap
