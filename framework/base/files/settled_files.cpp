#include "framework/base/files/settled_files.hpp"

#include <algorithm>
#include <cctype>
#include <set>
#include <utility>

namespace twinmap {

namespace fs = std::filesystem;

SettledFiles::SettledFiles(fs::path folder, std::vector<std::string> endings)
    : folder_(std::move(folder)), endings_(std::move(endings)) {}

bool SettledFiles::isWanted(const fs::path& file) const {
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return file.filename().string().front() != '.' &&
         std::find(endings_.begin(), endings_.end(), ending) != endings_.end();
}

/// Whether it is to be taken now.
bool SettledFiles::look(const fs::path& file, Clock::time_point now) {
  std::error_code gone;  // between the folder's list and here
  const std::uintmax_t size = fs::file_size(file, gone);
  const fs::file_time_type changed = gone ? fs::file_time_type() : fs::last_write_time(file, gone);
  if (gone) {
    return false;
  }
  const auto [at, is_new] = seen_.try_emplace(file, Seen{size, changed, now});
  Seen& seen = at->second;
  if (!is_new && (seen.size != size || seen.changed != changed)) {
    seen = {size, changed, now};
  }
  if (!seen.taken && now - seen.since < kSettled) {
    settling_ = true;
    return false;
  }
  return !std::exchange(seen.taken, true);
}

std::vector<fs::path> SettledFiles::take(Clock::time_point now) {
  settling_ = false;
  std::set<fs::path> there;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_)) {
    std::error_code gone;
    if (entry.is_regular_file(gone) && !gone && isWanted(entry.path())) {
      there.insert(entry.path());
    }
  }
  std::vector<fs::path> complete;
  for (const fs::path& file : there) {
    if (look(file, now)) {
      complete.push_back(file);
    }
  }
  for (auto at = seen_.begin(); at != seen_.end();) {  // what is gone is new where it comes again
    at = there.count(at->first) == 0 ? seen_.erase(at) : std::next(at);
  }
  return complete;
}

}  // namespace twinmap
