#include <fmt/core.h>

#include <iostream>
#include <stdexcept>

#include "framework/base/files/atomic_file.hpp"
#include "framework/cli/commands/commands.hpp"
#include "framework/store/store_upkeep.hpp"

namespace twinmap::cli {
namespace {

constexpr double kMebi = 1024.0 * 1024.0;

/// Prints the models and what is wrong with them. Returns how many files are.
std::size_t printModels(const std::vector<StoredModel>& models) {
  std::size_t problems = 0;
  for (const StoredModel& model : models) {
    std::cout << fmt::format(
        "{}: {} samples in {} chunks, {:.1f} MiB; {} of them failed, {} stored twice; {} set "
        "aside, {} temporary files\n  computed with: {}\n",
        model.folder.filename().string(), model.samples, model.chunks, double(model.bytes) / kMebi,
        model.failed, model.repeated, model.set_aside, model.temporary, model.computed_with);
    for (const std::string& problem : model.problems) {
      std::cerr << "twinmap: " << problem << "\n";
    }
    problems += model.problems.size();
  }
  return problems;
}

void requireNone(std::size_t problems, const std::string& what) {
  if (problems > 0) {
    throw std::runtime_error(fmt::format("{} {}", problems, what));
  }
}

}  // namespace

void listStore(const std::string& folder) {
  requireNone(printModels(listStoredModels(folder, StoreReading::kIndex)),
              "files are not as they were written");
}

void verifyStore(const std::string& folder) {
  requireNone(printModels(listStoredModels(folder, StoreReading::kWhole)),
              "files are not as they were written");
}

void mergeStore(const std::string& folder, const std::vector<std::string>& from) {
  std::size_t problems = 0;
  makeFolders(folder);
  for (const std::string& one : from) {
    const MergeResult result = mergeStores(folder, one);
    std::cout << fmt::format("{}: {} chunks copied, {} were there\n", one, result.copied, result.present);
    for (const std::string& problem : result.problems) {
      std::cerr << "twinmap: not copied: " << problem << "\n";
    }
    problems += result.problems.size();
  }
  requireNone(problems, "files are damaged and were not copied");
}

void pruneStore(const std::string& folder) {
  const PruneResult result = pruneStores(folder);
  std::cout << fmt::format("{} files removed, {:.1f} MiB\n", result.files, double(result.bytes) / kMebi);
}

}  // namespace twinmap::cli
