#pragma once

#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <unordered_map>
#include <vector>

#include "framework/store/chunk_file.hpp"
#include "framework/store/folder_lock.hpp"

namespace twinmap {

/// A chunk file that could not be used.
struct SetAsideChunk {
  std::filesystem::path file;  ///< where it is now
  std::string reason;          ///< "its checksum is wrong"
};

enum class StoreAccess {
  kReadWrite,  ///< one owner at a time
  kReadOnly,   ///< changes nothing, also while another process writes; a folder that is not there is empty
};

/// Simulated samples on disk, found again by the bits of their parameter point. A store holds the samples of
/// one model: `content` is the text of all that determines a sample beside its point, and each content has a
/// folder of its own, `root`/<digest of content>, so that any number of stores can share a root.
///
/// Chunk files (chunk_file.hpp) are the truth, written whole or not at all; the index is built from them when
/// the store is opened. A chunk that is torn, truncated, altered or foreign is never used: it is renamed to
/// *.set-aside and reported, and its samples count as missing. Files of interrupted writes are removed.
///
/// A sample that failed is a result and is stored, with its reason, unless its failure depends on the machine
/// (SampleStatus::machine_dependent): such a failure is remembered as long as the store is open, so that all
/// that is done meanwhile sees the same outcome, and the sample is tried again next time.
///
/// All functions may be called from any thread; calls wait for one another. Errors of the file system are
/// std::runtime_error naming the file and the cause.
class TrajectoryStore {
 public:
  /// Cost: reads every chunk once. Throws std::runtime_error if another process has the folder (kReadWrite).
  TrajectoryStore(const std::filesystem::path& root, const std::string& content, Eigen::Index parameters,
                  Eigen::Index rows, StoreAccess access = StoreAccess::kReadWrite);

  bool contains(const Eigen::Ref<const Eigen::VectorXd>& point) const;

  /// Whether the sample is known and failed.
  bool hasFailed(const Eigen::Ref<const Eigen::VectorXd>& point) const;

  /// Columns of `points` (parameters x n) that are not stored, the first of equal ones only.
  std::vector<Eigen::Index> findMissing(const Eigen::MatrixXd& points) const;

  /// Writes a chunk with the samples and syncs it to disk; then they are found. If that fails, the store is
  /// as it was before.
  void append(const SampleBlock& block);

  /// The samples at `points`, in their order; for one that is not stored, NaN and a status that says so.
  /// Chunks are read and verified again: one that has been damaged since the store was opened is an error.
  SampleBlock load(const Eigen::MatrixXd& points) const;

  int getSampleCount() const;
  const std::filesystem::path& getFolder() const { return folder_; }
  const ChunkShape& getShape() const { return shape_; }
  const std::vector<SetAsideChunk>& getSetAside() const { return set_aside_; }

 private:
  struct Place {
    int chunk;  ///< in chunks_
    Eigen::Index column;
    bool ok;
  };
  struct ColumnCopy {
    Eigen::Index from, to;
  };

  void readAll(StoreAccess access);
  void readOne(const std::filesystem::path& file, StoreAccess access);
  void setAside(const std::filesystem::path& file, const std::string& reason, StoreAccess access);
  void addToIndex(const std::filesystem::path& file, const SampleBlock& block);
  void copyColumns(const std::filesystem::path& file, const std::vector<ColumnCopy>& copies,
                   SampleBlock& to) const;
  bool isKnown(const std::string& point_bits) const;

  std::filesystem::path folder_;
  ChunkShape shape_;
  std::unique_ptr<FolderLock> lock_;
  mutable std::mutex mutex_;
  std::vector<std::filesystem::path> chunks_;
  std::unordered_map<std::string, Place> places_;                    ///< by the bits of the point
  std::unordered_map<std::string, SampleStatus> not_kept_failures_;  ///< machine-dependent, not on disk
  std::vector<SetAsideChunk> set_aside_;
};

}  // namespace twinmap
