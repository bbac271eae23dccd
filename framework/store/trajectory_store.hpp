#pragma once

#include <filesystem>
#include <mutex>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "framework/store/chunk_file.hpp"

namespace twinmap {

/// A chunk file that could not be used.
struct SetAsideChunk {
  std::filesystem::path file;  ///< where it is now
  std::string reason;          ///< "its checksum is wrong"
};

enum class StoreAccess {
  kReadWrite,  ///< any number of processes at a time, on any machines that share the folder
  kReadOnly,   ///< changes nothing; a folder that is not there is empty
};

/// Simulated samples on disk, found again by the bits of their parameter point. A store holds the samples of
/// one model: `content` is the text of all that determines a sample beside its point, and each content has a
/// folder of its own, `root`/<digest of content>, so that any number of stores can share a root.
///
/// Chunk files (chunk_file.hpp) are the truth, written whole or not at all, under names of their own bytes;
/// the index is built from them when the store is opened, without reading the responses. A chunk that is
/// torn, truncated, altered or foreign is never used: it is renamed to *.set-aside and reported, when its
/// header shows it, or by verify(), and its samples count as missing. Files of interrupted writes of this
/// machine's processes are removed.
///
/// Processes that write the same store share nothing but the folder and need no lock of it. It must rename
/// atomically within a folder and show a file that was synced and closed whole to whoever opens it under its
/// name after that (NFS does, by close-to-open consistency). Files that others add are found by refresh().
///
/// A sample that failed is a result and is stored, with its reason, unless its failure depends on the machine
/// (SampleStatus::machine_dependent): such a failure is remembered as long as the store is open, so that all
/// that is done meanwhile sees the same outcome, and the sample is tried again next time.
///
/// All functions may be called from any thread; calls wait for one another. Errors of the file system are
/// std::runtime_error naming the file and the cause.
class TrajectoryStore {
 public:
  /// Cost: 0.1 ms a chunk and 1 us a sample; 100 bytes a sample stay in memory.
  TrajectoryStore(const std::filesystem::path& root, const std::string& content, Eigen::Index parameters,
                  Eigen::Index rows, StoreAccess access = StoreAccess::kReadWrite);

  bool contains(const Eigen::Ref<const Eigen::VectorXd>& point) const;

  /// Whether the sample is known and failed.
  bool hasFailed(const Eigen::Ref<const Eigen::VectorXd>& point) const;

  /// Columns of `points` (parameters x n) that are not stored, the first of equal ones only.
  std::vector<Eigen::Index> findMissing(const Eigen::MatrixXd& points) const;

  /// Finds what other processes have stored meanwhile. Cost: lists the folder.
  void refresh();

  /// Reads the chunks that hold samples at `points` whole; what is damaged is set aside, and its samples are
  /// missing. Each chunk once as long as the store is open.
  void verify(const Eigen::MatrixXd& points);
  /// The same of all chunks.
  void verifyAll();

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

  struct Chunk {
    std::filesystem::path file;
    bool verified = false;
  };

  void readNew();
  void readOne(const std::filesystem::path& file);
  void readWhole(const std::filesystem::path& file);
  void setAside(const std::filesystem::path& file, const std::string& reason);
  void addToIndex(const Chunk& chunk, const ChunkIndex& index);
  /// False if some had to be forgotten.
  bool verifyChunks(const std::vector<int>& chunks);
  void verifyChunk(int chunk);
  void forget(const std::vector<int>& chunks);
  void copyColumns(const std::filesystem::path& file, const std::vector<ColumnCopy>& copies,
                   SampleBlock& to) const;
  bool isKnown(const std::string& point_bits) const;

  std::filesystem::path folder_;
  ChunkShape shape_;
  StoreAccess access_;
  mutable std::mutex mutex_;
  std::vector<Chunk> chunks_;
  std::unordered_set<std::string> known_files_;                      ///< names of chunks that were looked at
  std::unordered_map<std::string, Place> places_;                    ///< by the bits of the point
  std::unordered_map<std::string, SampleStatus> not_kept_failures_;  ///< machine-dependent, not on disk
  std::vector<SetAsideChunk> set_aside_;
};

}  // namespace twinmap
