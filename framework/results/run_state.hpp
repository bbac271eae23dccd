#pragma once

#include <filesystem>
#include <string>

namespace twinmap {

/// Where a run keeps simulated samples: `given`, or the folder's own chunks if that is empty.
inline std::filesystem::path getStoreRoot(const std::filesystem::path& folder,
                                          const std::filesystem::path& given) {
  return given.empty() ? folder / "chunks" : given;
}

/// Writes store.txt, the absolute path of the given store; removes it if the folder's own chunks are used.
void noteStore(const std::filesystem::path& folder, const std::filesystem::path& given);

/// The store of the run, sweep or case of a sweep in the folder, as noteStore() left it.
std::filesystem::path findStore(const std::filesystem::path& folder);

/// Throws ExperimentError, naming the keys that differ with both values, if the folder holds another
/// experiment than `resolved`, the text of its resolved.yaml: what is there is not mixed with other results.
void requireSameExperiment(const std::filesystem::path& folder, const std::string& resolved);

/// Whether all files of a run are there: provenance.json is written last, and then the report from all
/// others.
bool isComplete(const std::filesystem::path& folder);

/// From here on the folder is not complete, until provenance.json is written again.
void beginRun(const std::filesystem::path& folder, const std::string& resolved);

}  // namespace twinmap
