#include "framework/store/trajectory_store.hpp"

#include <algorithm>
#include <cassert>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <string_view>

#include "framework/base/files/atomic_file.hpp"

namespace twinmap {
namespace {

namespace fs = std::filesystem;

constexpr const char* kChunkSuffix = ".chunk";
constexpr const char* kSetAsideSuffix = ".set-aside";

std::string_view viewBits(const Eigen::Ref<const Eigen::VectorXd>& point) {
  return {reinterpret_cast<const char*>(point.data()), point.size() * sizeof(double)};
}

std::string getBits(const Eigen::Ref<const Eigen::VectorXd>& point) {
  return std::string(viewBits(point));
}

std::vector<fs::path> listFiles(const fs::path& folder, const std::string& suffix) {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == suffix) {
      files.push_back(entry.path());
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

/// For people, and to see what differs between two folders; chunks carry the digest themselves.
void writeContent(const fs::path& file, const std::string& content) {
  if (!fs::exists(file) || readBytes(file) != content) {
    writeTextFile(file, content);
  }
}

SampleBlock selectColumns(const SampleBlock& block, const std::vector<int>& columns) {
  SampleBlock selected;
  selected.parameters = block.parameters(Eigen::all, columns);
  selected.responses = block.responses(Eigen::all, columns);
  for (const int column : columns) {
    selected.statuses.push_back(block.statuses[column]);
  }
  return selected;
}

ChunkIndex makeIndex(const SampleBlock& block) {
  ChunkIndex index{block.parameters, {}};
  for (const SampleStatus& status : block.statuses) {
    index.ok.push_back(status.ok);
  }
  return index;
}

void removeAbandoned(const fs::path& folder) {
  for (const fs::path& file : listFiles(folder, kTemporarySuffix)) {
    std::error_code ignored;  // another process may be doing the same
    if (isAbandoned(file)) {
      fs::remove(file, ignored);
    }
  }
}

/// False if the file is not there, any more.
bool renameIfThere(const fs::path& from, const fs::path& to) {
  try {
    renameFile(from, to);
    return true;
  } catch (const std::runtime_error&) {
    if (fs::exists(from)) {
      throw;
    }
    return false;
  }
}

bool isWhole(const fs::path& file, const ChunkShape& shape) {
  try {
    readChunk(readBytes(file), shape);
    return true;
  } catch (const std::runtime_error&) {
    return false;
  }
}

}  // namespace

TrajectoryStore::TrajectoryStore(const fs::path& root, const std::string& content, Eigen::Index parameters,
                                 Eigen::Index rows, StoreAccess access)
    : shape_{calcDigest(content.data(), content.size()), parameters, rows}, access_(access) {
  folder_ = root / toHex(shape_.content);
  if (access == StoreAccess::kReadWrite) {
    makeFolders(folder_);
    removeAbandoned(folder_);
    writeContent(folder_ / "content.yaml", content);
  }
  readNew();
}

void TrajectoryStore::readNew() {
  if (access_ == StoreAccess::kReadOnly && !fs::exists(folder_)) {
    return;
  }
  for (const fs::path& file : listFiles(folder_, kChunkSuffix)) {
    if (known_files_.insert(file.filename().string()).second) {
      readOne(file);
    }
  }
}

void TrajectoryStore::refresh() {
  const std::lock_guard<std::mutex> guard(mutex_);
  readNew();
}

void TrajectoryStore::readOne(const fs::path& file) {
  try {
    addToIndex({file, false}, readChunkIndex(file, shape_));
  } catch (const BadChunk& bad) {
    setAside(file, bad.what());
  } catch (const std::runtime_error&) {
    if (fs::exists(file)) {  // else another process has set it aside or removed it meanwhile
      readWhole(file);
    }
  }
}

/// Whether it is of a later format, or damaged where it says which.
void TrajectoryStore::readWhole(const fs::path& file) {
  try {
    addToIndex({file, true}, makeIndex(readChunk(readBytes(file), shape_)));
  } catch (const BadChunk& bad) {
    setAside(file, bad.what());
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(file.string() + ": " + error.what());
  }
}

void TrajectoryStore::setAside(const fs::path& file, const std::string& reason) {
  fs::path now = file;
  if (access_ == StoreAccess::kReadWrite) {
    now += kSetAsideSuffix;
    if (!renameIfThere(file, now)) {
      return;
    }
    known_files_.erase(file.filename().string());  // the same samples may be written again
    if (isWhole(now, shape_)) {  // another process had set the damaged one aside and written them again
      renameIfThere(now, file);
      return;
    }
  }
  set_aside_.push_back({now, reason});
}

void TrajectoryStore::addToIndex(const Chunk& chunk, const ChunkIndex& index) {
  const int number = static_cast<int>(chunks_.size());
  chunks_.push_back(chunk);
  for (int column = 0; column < index.parameters.cols(); ++column) {
    places_.insert({getBits(index.parameters.col(column)), {number, column, index.ok[column]}});
  }
}

void TrajectoryStore::verifyChunk(int chunk) {
  const fs::path file = chunks_[chunk].file;
  try {
    readChunk(readBytes(file), shape_);
    chunks_[chunk].verified = true;
  } catch (const BadChunk& bad) {
    setAside(file, bad.what());
  } catch (const std::runtime_error&) {
    if (fs::exists(file)) {
      throw;
    }
  }
}

/// Samples may lie in other chunks as well, so that these are read for the next of them.
void TrajectoryStore::forget(const std::vector<int>& chunks) {
  const std::unordered_set<int> gone(chunks.begin(), chunks.end());
  places_.clear();
  std::vector<Chunk> kept;
  for (int i = 0; i < static_cast<int>(chunks_.size()); ++i) {
    if (gone.count(i) == 0) {
      kept.push_back(chunks_[i]);
    }
  }
  chunks_.clear();
  for (const Chunk& chunk : kept) {
    const std::size_t before = chunks_.size();
    readOne(chunk.file);
    if (chunks_.size() > before) {
      chunks_.back().verified = chunk.verified;
    }
  }
  readNew();
}

void TrajectoryStore::verify(const Eigen::MatrixXd& points) {
  const std::lock_guard<std::mutex> guard(mutex_);
  bool again = true;
  while (again) {  // what was damaged may be stored elsewhere as well
    std::set<int> needed;
    for (const auto& point : points.colwise()) {
      if (const auto place = places_.find(getBits(point)); place != places_.end()) {
        needed.insert(place->second.chunk);
      }
    }
    again = !verifyChunks({needed.begin(), needed.end()});
  }
}

void TrajectoryStore::verifyAll() {
  const std::lock_guard<std::mutex> guard(mutex_);
  std::vector<int> all(chunks_.size());
  std::iota(all.begin(), all.end(), 0);
  verifyChunks(all);
}

bool TrajectoryStore::verifyChunks(const std::vector<int>& chunks) {
  std::vector<int> bad;
  for (const int chunk : chunks) {
    if (!chunks_[chunk].verified) {
      verifyChunk(chunk);
      if (!chunks_[chunk].verified) {
        bad.push_back(chunk);
      }
    }
  }
  if (!bad.empty()) {
    forget(bad);
  }
  return bad.empty();
}

bool TrajectoryStore::isKnown(const std::string& point_bits) const {
  return places_.count(point_bits) > 0 || not_kept_failures_.count(point_bits) > 0;
}

bool TrajectoryStore::contains(const Eigen::Ref<const Eigen::VectorXd>& point) const {
  const std::lock_guard<std::mutex> guard(mutex_);
  return isKnown(getBits(point));
}

bool TrajectoryStore::hasFailed(const Eigen::Ref<const Eigen::VectorXd>& point) const {
  const std::lock_guard<std::mutex> guard(mutex_);
  const std::string bits = getBits(point);
  const auto place = places_.find(bits);
  return place == places_.end() ? not_kept_failures_.count(bits) > 0 : !place->second.ok;
}

std::vector<Eigen::Index> TrajectoryStore::findMissing(const Eigen::MatrixXd& points) const {
  const std::lock_guard<std::mutex> guard(mutex_);
  std::vector<Eigen::Index> missing;
  std::unordered_set<std::string_view> seen;  // looks into `points`
  seen.reserve(static_cast<std::size_t>(points.cols()));
  const bool is_empty = places_.empty() && not_kept_failures_.empty();
  for (Eigen::Index column = 0; column < points.cols(); ++column) {
    const std::string_view bits = viewBits(points.col(column));
    if ((is_empty || !isKnown(std::string(bits))) && seen.insert(bits).second) {
      missing.push_back(column);
    }
  }
  return missing;
}

void TrajectoryStore::append(const SampleBlock& block) {
  assert(access_ == StoreAccess::kReadWrite && "a store opened read-only");
  const std::lock_guard<std::mutex> guard(mutex_);
  std::vector<int> kept;
  for (int column = 0; column < block.getSampleCount(); ++column) {
    if (!block.statuses[column].machine_dependent) {
      kept.push_back(column);
    }
  }
  if (!kept.empty()) {
    const SampleBlock chunk = selectColumns(block, kept);
    const std::string bytes = makeChunk(chunk, shape_);
    const fs::path file = folder_ / (toHex(calcDigest(bytes.data(), bytes.size())) + kChunkSuffix);
    writeBytes(file, bytes.data(), bytes.size());
    known_files_.insert(file.filename().string());
    addToIndex({file, true}, makeIndex(chunk));
  }
  for (int column = 0; column < block.getSampleCount(); ++column) {
    if (block.statuses[column].machine_dependent) {
      not_kept_failures_.insert({getBits(block.parameters.col(column)), block.statuses[column]});
    }
  }
}

void TrajectoryStore::copyColumns(const fs::path& file, const std::vector<ColumnCopy>& copies,
                                  SampleBlock& to) const {
  try {
    const SampleBlock from = readChunk(readBytes(file), shape_);
    for (const ColumnCopy& copy : copies) {
      to.responses.col(copy.to) = from.responses.col(copy.from);
      to.statuses[copy.to] = from.statuses[copy.from];
    }
  } catch (const BadChunk& bad) {
    throw std::runtime_error(file.string() + ": has been damaged since it was opened: " + bad.what() +
                             "; start again, and its samples are simulated again");
  }
}

SampleBlock TrajectoryStore::load(const Eigen::MatrixXd& points) const {
  const std::lock_guard<std::mutex> guard(mutex_);
  SampleBlock loaded;
  loaded.parameters = points;
  loaded.responses.setConstant(shape_.rows, points.cols(), std::numeric_limits<double>::quiet_NaN());
  loaded.statuses.assign(points.cols(), {false, "not simulated"});
  std::map<int, std::vector<ColumnCopy>> copies;  // by chunk
  for (Eigen::Index column = 0; column < points.cols(); ++column) {
    const std::string bits = getBits(points.col(column));
    if (const auto place = places_.find(bits); place != places_.end()) {
      copies[place->second.chunk].push_back({place->second.column, column});
    } else if (const auto failure = not_kept_failures_.find(bits); failure != not_kept_failures_.end()) {
      loaded.statuses[column] = failure->second;
    }
  }
  for (const auto& [chunk, of_chunk] : copies) {
    copyColumns(chunks_[chunk].file, of_chunk, loaded);
  }
  return loaded;
}

int TrajectoryStore::getSampleCount() const {
  const std::lock_guard<std::mutex> guard(mutex_);
  return static_cast<int>(places_.size());
}

}  // namespace twinmap
