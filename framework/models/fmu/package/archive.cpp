#include "framework/models/fmu/package/archive.hpp"

#include <sys/stat.h>
#include <zip.h>

#include <algorithm>
#include <fstream>
#include <memory>
#include <set>

#include "framework/base/text/source_location.hpp"

namespace twinmap::fmi {
namespace {

namespace fs = std::filesystem;

struct CloseArchive {
  void operator()(zip_t* archive) const { zip_discard(archive); }
};
struct CloseEntry {
  void operator()(zip_file_t* entry) const { zip_fclose(entry); }
};
using Archive = std::unique_ptr<zip_t, CloseArchive>;

Archive openArchive(const std::string& file) {
  int code = 0;
  Archive archive(zip_open(file.c_str(), ZIP_RDONLY, &code));
  if (archive == nullptr) {
    zip_error_t error;
    zip_error_init_with_code(&error, code);
    const std::string reason = zip_error_strerror(&error);
    zip_error_fini(&error);
    const bool no_archive = code == ZIP_ER_NOZIP || code == ZIP_ER_INCONS;
    throw ExperimentError(file + (no_archive ? ": is not an FMU: not a ZIP archive" : ": cannot be opened") +
                          " (" + reason + ")");
  }
  return archive;
}

struct Entry {
  zip_uint64_t index;
  std::string path;  ///< checked
  bool is_folder;
};

/// Windows tools write backslashes.
std::string normalise(std::string name) {
  std::replace(name.begin(), name.end(), '\\', '/');
  return name;
}

bool leavesFolder(const std::string& path) {
  if (path.empty() || path.front() == '/' || (path.size() > 1 && path[1] == ':')) {
    return true;
  }
  const fs::path parts(path);
  return std::any_of(parts.begin(), parts.end(), [](const fs::path& part) { return part == ".."; });
}

bool isLink(zip_t* archive, zip_uint64_t index) {
  zip_uint8_t system = 0;
  zip_uint32_t attributes = 0;
  zip_file_get_external_attributes(archive, index, 0, &system, &attributes);
  const mode_t mode = attributes >> 16;  // as Unix writes them
  return system == ZIP_OPSYS_UNIX && (S_ISLNK(mode) || S_ISCHR(mode) || S_ISBLK(mode) || S_ISFIFO(mode));
}

std::vector<Entry> listEntries(zip_t* archive, const std::string& file) {
  constexpr zip_int64_t kMaxEntries = 100000;
  constexpr zip_uint64_t kMaxBytes = 4ULL << 30;
  const zip_int64_t count = zip_get_num_entries(archive, 0);
  if (count > kMaxEntries) {
    throw ExperimentError(file + ": has more than 100000 entries");
  }
  std::vector<Entry> entries;
  zip_uint64_t bytes = 0;
  for (zip_uint64_t i = 0; i < static_cast<zip_uint64_t>(count); ++i) {
    zip_stat_t stat;
    if (zip_stat_index(archive, i, 0, &stat) != 0 || (stat.valid & ZIP_STAT_NAME) == 0) {
      throw ExperimentError(file + ": entry " + std::to_string(i) + " is damaged");
    }
    const std::string path = normalise(stat.name);
    if (leavesFolder(path) || isLink(archive, i)) {
      throw ExperimentError(file + ": is refused: its entry '" + path +
                            "' would lead out of the folder that it is unpacked to");
    }
    bytes += (stat.valid & ZIP_STAT_SIZE) != 0 ? stat.size : 0;
    entries.push_back({i, path, path.back() == '/'});
  }
  if (bytes > kMaxBytes) {
    throw ExperimentError(file + ": unpacks to more than 4 GiB");
  }
  return entries;
}

/// "linux64" of "binaries/linux64/crane.so", or "".
std::string getPlatform(const std::string& path) {
  const std::string kFolder = "binaries/";
  const std::size_t end = path.find('/', kFolder.size());
  return path.rfind(kFolder, 0) == 0 && end != std::string::npos
             ? path.substr(kFolder.size(), end - kFolder.size())
             : "";
}

void write(zip_t* archive, const Entry& entry, const fs::path& target, const std::string& file) {
  const std::unique_ptr<zip_file_t, CloseEntry> source(zip_fopen_index(archive, entry.index, 0));
  std::ofstream out(target, std::ios::binary | std::ios::trunc);
  std::vector<char> buffer(1 << 16);
  zip_int64_t count = source == nullptr ? -1 : 0;
  while (source != nullptr && (count = zip_fread(source.get(), buffer.data(), buffer.size())) > 0) {
    out.write(buffer.data(), count);
  }
  if (count < 0) {
    throw ExperimentError(file + ": '" + entry.path + "' cannot be unpacked: " + zip_strerror(archive));
  }
  out.close();
  if (!out) {
    throw ExperimentError(file + ": '" + entry.path + "' cannot be written to " + target.string());
  }
}

bool isWanted(const std::string& path, const std::vector<std::string>& platforms) {
  const std::string platform = getPlatform(path);
  const bool own = std::find(platforms.begin(), platforms.end(), platform) != platforms.end();
  return (platform.empty() || own) && path.rfind("documentation/", 0) != 0;
}

}  // namespace

ArchiveContent unpackArchive(const std::string& file, const fs::path& folder,
                             const std::vector<std::string>& platforms) {
  const Archive archive = openArchive(file);
  const std::vector<Entry> entries = listEntries(archive.get(), file);
  ArchiveContent content;
  std::set<std::string> found;
  for (const Entry& entry : entries) {
    if (const std::string platform = getPlatform(entry.path); !platform.empty()) {
      found.insert(platform);
    }
    const fs::path target = folder / entry.path;
    std::error_code failure;
    fs::create_directories(entry.is_folder ? target : target.parent_path(), failure);
    if (failure) {
      throw ExperimentError(file + ": '" + entry.path + "' cannot be unpacked: " + failure.message());
    }
    if (!entry.is_folder) {
      content.files.push_back(entry.path);
      if (isWanted(entry.path, platforms)) {
        write(archive.get(), entry, target, file);
      }
    }
  }
  content.platforms.assign(found.begin(), found.end());
  return content;
}

}  // namespace twinmap::fmi
