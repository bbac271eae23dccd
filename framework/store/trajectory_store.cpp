#include "framework/store/trajectory_store.hpp"

#include <algorithm>
#include <cassert>
#include <limits>
#include <map>
#include <unordered_set>

#include "framework/store/atomic_file.hpp"

namespace twinmap {
namespace {

namespace fs = std::filesystem;

constexpr const char* kChunkSuffix = ".chunk";
constexpr const char* kSetAsideSuffix = ".set-aside";

std::string getBits(const Eigen::Ref<const Eigen::VectorXd>& point) {
  return {reinterpret_cast<const char*>(point.data()), point.size() * sizeof(double)};
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

}  // namespace

TrajectoryStore::TrajectoryStore(const fs::path& root, const std::string& content, Eigen::Index parameters,
                                 Eigen::Index rows, StoreAccess access)
    : shape_{calcDigest(content.data(), content.size()), parameters, rows} {
  folder_ = root / toHex(shape_.content);
  if (access == StoreAccess::kReadWrite) {
    makeFolders(folder_);
    lock_ = std::make_unique<FolderLock>(folder_);
    for (const fs::path& file : listFiles(folder_, kTemporarySuffix)) {
      fs::remove(file);
    }
    writeContent(folder_ / "content.yaml", content);
  }
  readAll(access);
}

void TrajectoryStore::readAll(StoreAccess access) {
  if (access == StoreAccess::kReadOnly && !fs::exists(folder_)) {
    return;
  }
  for (const fs::path& file : listFiles(folder_, kChunkSuffix)) {
    readOne(file, access);
  }
}

void TrajectoryStore::readOne(const fs::path& file, StoreAccess access) {
  const std::string bytes = readBytes(file);
  try {
    addToIndex(file, readChunk(bytes, shape_));
  } catch (const BadChunk& bad) {
    setAside(file, bad.what(), access);
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(file.string() + ": " + error.what());
  }
}

void TrajectoryStore::setAside(const fs::path& file, const std::string& reason, StoreAccess access) {
  fs::path now = file;
  if (access == StoreAccess::kReadWrite) {
    now += kSetAsideSuffix;
    renameFile(file, now);
  }
  set_aside_.push_back({now, reason});
}

void TrajectoryStore::addToIndex(const fs::path& file, const SampleBlock& block) {
  const int chunk = static_cast<int>(chunks_.size());
  chunks_.push_back(file);
  for (int column = 0; column < block.getSampleCount(); ++column) {
    places_.insert({getBits(block.parameters.col(column)), {chunk, column, block.statuses[column].ok}});
  }
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
  std::unordered_set<std::string> seen;
  for (Eigen::Index column = 0; column < points.cols(); ++column) {
    const std::string bits = getBits(points.col(column));
    if (!isKnown(bits) && seen.insert(bits).second) {
      missing.push_back(column);
    }
  }
  return missing;
}

void TrajectoryStore::append(const SampleBlock& block) {
  assert(lock_ != nullptr && "a store opened read-only");
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
    addToIndex(file, chunk);
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
    copyColumns(chunks_[chunk], of_chunk, loaded);
  }
  return loaded;
}

int TrajectoryStore::getSampleCount() const {
  const std::lock_guard<std::mutex> guard(mutex_);
  return static_cast<int>(places_.size());
}

}  // namespace twinmap
