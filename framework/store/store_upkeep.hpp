#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace twinmap {

/// The samples of one model in a folder of stores (TrajectoryStore), as its files say.
struct StoredModel {
  std::filesystem::path folder;
  std::string computed_with;  ///< the lines of content.yaml on solver and build, joined by "; "
  int chunks = 0;
  int samples = 0;   ///< distinct points
  int repeated = 0;  ///< samples that lie in more than one chunk, beyond the first
  int failed = 0;    ///< of the distinct ones
  std::uint64_t bytes = 0;
  int set_aside = 0, temporary = 0;   ///< files
  std::vector<std::string> problems;  ///< "FILE: its checksum is wrong"; damaged chunks are not counted
};

/// How much of the chunks is read.
enum class StoreReading {
  kIndex,  ///< points and statuses alone
  kWhole,  ///< every byte, compared with its checksum
};

/// The models in the folder `root`, by the names of their folders. Changes nothing; what others add or remove
/// meanwhile may or may not be in it. Throws std::runtime_error if there is no such folder.
std::vector<StoredModel> listStoredModels(const std::filesystem::path& root, StoreReading reading);

struct MergeResult {
  int copied = 0, present = 0;        ///< chunks
  std::vector<std::string> problems;  ///< chunks that were not copied, and why
};

/// Copies the chunks of the stores in `from` into `root` that are not there, each read whole and compared
/// with its checksum first; what is damaged stays where it is. Other processes may use both meanwhile.
MergeResult mergeStores(const std::filesystem::path& root, const std::filesystem::path& from);

struct PruneResult {
  int files = 0;
  std::uint64_t bytes = 0;
};

/// Removes what no run needs: chunks that were set aside, what interrupted writes left (of this machine's
/// ended processes at once, of others after a day), and chunks whose samples lie all in other, whole chunks.
PruneResult pruneStores(const std::filesystem::path& root);

}  // namespace twinmap
