#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "framework/experiment/model/model_spec.hpp"
#include "framework/tracking/track_record.hpp"
#include "framework/tracking/track_space.hpp"
#include "kernels/tracking/whole_course.hpp"

namespace twinmap {

/// The records of all measurements, a line each, in the order they came: it grows, the state does not.
class TrackHistory {
 public:
  /// bytes: what of the file belongs to the state; anything behind was never answered and is cut off. Throws
  /// std::runtime_error naming the file where it has less.
  TrackHistory(std::filesystem::path file, std::uint64_t bytes);

  /// Appends a line. Throws std::runtime_error naming the file where that fails; it is as before then.
  void add(const TrackRecord& record);

  /// Whether a measurement of such a table was counted, at any time. The first call reads the file; from then
  /// on 8 bytes of memory a measurement. A table is taken for another with a probability of 2^-64 each.
  bool contains(const std::string& digest);

  std::uint64_t getBytes() const { return bytes_; }
  const std::filesystem::path& getFile() const { return file_; }

  /// All, in the order of their times.
  std::vector<TrackRecord> read(Eigen::Index parameters, Eigen::Index conditions) const;

 private:
  std::filesystem::path file_;
  std::uint64_t bytes_;
  std::optional<std::vector<std::uint64_t>> digests_;  // the first half of each, ascending
};

/// What is known of each parameter at each measurement, in coordinates: by those until then, and by all.
struct TrackCourse {
  std::vector<TrackRecord> records;  ///< N, in their order
  tracking::WholeCourse whole;
};

/// Of all records (in order).
TrackCourse calcTrackCourse(std::vector<TrackRecord> records, const tracking::Model& model);

/// CSV: time, source, status, used, parameter, unit, mean, sd, lower, upper, smoothed_mean, smoothed_sd,
/// smoothed_lower, smoothed_upper.
std::string makeTrackCsv(const TrackCourse& course, const std::vector<ParameterSpec>& parameters,
                         const TrackSpace& space);

}  // namespace twinmap
