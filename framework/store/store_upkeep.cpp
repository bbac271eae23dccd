#include "framework/store/store_upkeep.hpp"

#include <algorithm>
#include <chrono>
#include <stdexcept>
#include <unordered_map>

#include "framework/base/files/atomic_file.hpp"
#include "framework/store/chunk_file.hpp"

namespace twinmap {
namespace {

namespace fs = std::filesystem;

constexpr const char* kContent = "content.yaml";

/// All of a folder in the order of their names; what vanishes meanwhile is left out.
std::vector<fs::path> listFolder(const fs::path& folder) {
  std::vector<fs::path> found;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    found.push_back(entry.path());
  }
  std::sort(found.begin(), found.end());
  return found;
}

std::vector<fs::path> listModelFolders(const fs::path& root) {
  if (!fs::is_directory(root)) {
    throw std::runtime_error(root.string() + ": is not a folder of simulated samples");
  }
  std::vector<fs::path> folders;
  for (const fs::path& path : listFolder(root)) {
    if (fs::exists(path / kContent)) {
      folders.push_back(path);
    }
  }
  return folders;
}

std::string takeComputedWith(const std::string& content) {
  const std::string key = "\nsolver:\n";
  const std::size_t begin = content.find(key);
  std::string text;
  for (std::size_t at = begin; at != std::string::npos && at + key.size() < content.size();) {
    at = at == begin ? begin + key.size() : at;
    const std::size_t end = std::min(content.find('\n', at), content.size());
    if (content.compare(at, 2, "  ") != 0) {
      break;
    }
    text += (text.empty() ? "" : "; ") + content.substr(at + 2, end - at - 2);
    at = end + 1;
  }
  return text;
}

/// Where each point lies first, and which chunks have none that no chunk before them has.
struct PointIndex {
  std::unordered_map<std::string, bool> ok_of_point;
  std::vector<fs::path> repeated_chunks;
  int repeated = 0;

  void add(const fs::path& chunk, const ChunkIndex& index) {
    int fresh = 0;
    for (Eigen::Index i = 0; i < index.parameters.cols(); ++i) {
      const auto point = index.parameters.col(i);
      const std::string bits(reinterpret_cast<const char*>(point.data()), point.size() * sizeof(double));
      fresh += ok_of_point.emplace(bits, index.ok[static_cast<std::size_t>(i)]).second ? 1 : 0;
    }
    repeated += static_cast<int>(index.parameters.cols()) - fresh;
    if (fresh == 0) {
      repeated_chunks.push_back(chunk);
    }
  }
};

void readChunkOf(const fs::path& file, StoreReading reading, StoredModel& model, PointIndex& points) {
  try {
    const ChunkShape shape = readChunkShape(file);
    if (toHex(shape.content) != model.folder.filename()) {
      throw BadChunk("it holds samples of another model, " + toHex(shape.content));
    }
    if (reading == StoreReading::kWhole) {
      readChunk(readBytes(file), shape);
    }
    points.add(file, readChunkIndex(file, shape));
    ++model.chunks;
    model.bytes += fs::file_size(file);
  } catch (const std::runtime_error& error) {
    if (fs::exists(file)) {
      model.problems.push_back(file.string() + ": " + error.what());
    }
  }
}

StoredModel readModel(const fs::path& folder, StoreReading reading, PointIndex& points) {
  StoredModel model;
  model.folder = folder;
  const std::string content = readBytes(folder / kContent);
  model.computed_with = takeComputedWith(content);
  if (toHex(calcDigest(content.data(), content.size())) != folder.filename()) {
    model.problems.push_back((folder / kContent).string() +
                             ": does not have the digest that names its folder");
  }
  for (const fs::path& file : listFolder(folder)) {
    const fs::path extension = file.extension();
    model.set_aside += extension == ".set-aside" ? 1 : 0;
    model.temporary += extension == kTemporarySuffix ? 1 : 0;
    if (extension == ".chunk") {
      readChunkOf(file, reading, model, points);
    }
  }
  model.samples = static_cast<int>(points.ok_of_point.size());
  model.repeated = points.repeated;
  model.failed = static_cast<int>(std::count_if(points.ok_of_point.begin(), points.ok_of_point.end(),
                                                [](const auto& point) { return !point.second; }));
  return model;
}

void mergeChunk(const fs::path& file, const fs::path& folder, MergeResult& result) {
  try {
    const ChunkShape shape = readChunkShape(file);
    if (toHex(shape.content) != folder.filename()) {
      throw BadChunk("it holds samples of another model, " + toHex(shape.content));
    }
    const std::string bytes = readBytes(file);
    readChunk(bytes, shape);
    const fs::path to = folder / (toHex(calcDigest(bytes.data(), bytes.size())) + ".chunk");
    if (fs::exists(to)) {
      ++result.present;
      return;
    }
    writeBytes(to, bytes.data(), bytes.size());
    ++result.copied;
  } catch (const DiskFull&) {
    throw;
  } catch (const std::runtime_error& error) {
    result.problems.push_back(file.string() + ": " + error.what());
  }
}

bool isOld(const fs::path& file) {
  constexpr std::chrono::hours kDay(24);
  std::error_code error;
  const fs::file_time_type time = fs::last_write_time(file, error);
  return !error && fs::file_time_type::clock::now() - time > kDay;
}

void removeFile(const fs::path& file, PruneResult& result) {
  std::error_code error;
  const std::uintmax_t size = fs::file_size(file, error);
  if (!error && fs::remove(file, error)) {
    ++result.files;
    result.bytes += size;
  }
}

}  // namespace

std::vector<StoredModel> listStoredModels(const fs::path& root, StoreReading reading) {
  std::vector<StoredModel> models;
  for (const fs::path& folder : listModelFolders(root)) {
    PointIndex points;
    models.push_back(readModel(folder, reading, points));
  }
  return models;
}

MergeResult mergeStores(const fs::path& root, const fs::path& from) {
  MergeResult result;
  for (const fs::path& folder : listModelFolders(from)) {
    const std::string content = readBytes(folder / kContent);
    if (toHex(calcDigest(content.data(), content.size())) != folder.filename()) {
      result.problems.push_back((folder / kContent).string() +
                                ": does not have the digest that names its folder");
      continue;
    }
    const fs::path to = root / folder.filename();
    makeFolders(to);
    if (!fs::exists(to / kContent)) {
      writeTextFile(to / kContent, content);
    }
    for (const fs::path& file : listFolder(folder)) {
      if (file.extension() == ".chunk") {
        mergeChunk(file, to, result);
      }
    }
  }
  return result;
}

PruneResult pruneStores(const fs::path& root) {
  PruneResult result;
  for (const fs::path& folder : listModelFolders(root)) {
    PointIndex points;
    readModel(folder, StoreReading::kWhole, points);
    for (const fs::path& chunk : points.repeated_chunks) {
      removeFile(chunk, result);
    }
    for (const fs::path& file : listFolder(folder)) {
      const bool abandoned = file.extension() == kTemporarySuffix && (isAbandoned(file) || isOld(file));
      if (abandoned || file.extension() == ".set-aside") {
        removeFile(file, result);
      }
    }
  }
  return result;
}

}  // namespace twinmap
