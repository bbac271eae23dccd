#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace twinmap {

/// The files of a folder, as they come and are complete. Complete is what has the same size and time of its
/// last change at two looks a second apart. So it needs nothing of the writer, nor of clocks of other
/// machines.
class SettledFiles {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::seconds kSettled{1};

  /// endings: of names, in small letters, ".csv". What begins with a dot is left alone.
  SettledFiles(std::filesystem::path folder, std::vector<std::string> endings);

  /// A look: the files, by their names, that are complete and were not taken yet, or have changed since.
  /// Throws std::filesystem::filesystem_error where the folder cannot be read.
  std::vector<std::filesystem::path> take(Clock::time_point now);

  /// Whether there were files that were not complete at the last look.
  bool areSettling() const { return settling_; }

 private:
  struct Seen {
    std::uintmax_t size = 0;
    std::filesystem::file_time_type changed{};
    Clock::time_point since{};
    bool taken = false;
  };

  bool isWanted(const std::filesystem::path& file) const;
  bool look(const std::filesystem::path& file, Clock::time_point now);

  std::filesystem::path folder_;
  std::vector<std::string> endings_;
  std::map<std::filesystem::path, Seen> seen_;
  bool settling_ = false;
};

}  // namespace twinmap
