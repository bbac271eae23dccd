#include "framework/tracking/track_history.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <sstream>
#include <stdexcept>

#include "framework/base/files/atomic_file.hpp"
#include "framework/base/text/csv.hpp"
#include "framework/estimation/interval_factor.hpp"

namespace twinmap {

using Eigen::Index;

TrackHistory::TrackHistory(std::filesystem::path file, std::uint64_t bytes)
    : file_(std::move(file)), bytes_(bytes) {
  const std::uint64_t there = std::filesystem::exists(file_) ? std::filesystem::file_size(file_) : 0;
  if (there < bytes) {
    throw std::runtime_error(
        fmt::format("{}: the history has {} bytes, the state beside it belongs to {}; "
                    "restore it, or name another --state",
                    file_.string(), there, bytes));
  }
  if (there > bytes) {
    std::filesystem::resize_file(file_, bytes);
  }
}

namespace {

/// The first 16 of a digest's hexadecimal digits.
std::uint64_t readDigest(const std::string& digest) {
  return std::strtoull(digest.substr(0, 16).c_str(), nullptr, 16);
}

/// Of a line, without reading all of it: within a text of JSON no quote stands bare.
std::uint64_t findDigest(const std::string& line) {
  const std::string key = "\"digest\":";
  const std::size_t at = line.find('"', line.find(key) + key.size());
  return readDigest(line.substr(at + 1, 16));
}

/// Of all lines, ascending; of each the beginning is looked at alone, which is longer than any path.
std::vector<std::uint64_t> readDigests(const std::filesystem::path& path) {
  constexpr int kBeginning = 16384;
  std::vector<std::uint64_t> digests;
  std::string part(kBeginning, ' ');
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), &std::fclose);
  bool begins = true;
  while (file && std::fgets(part.data(), kBeginning, file.get()) != nullptr) {
    const std::string line(part.c_str());
    if (begins) {
      digests.push_back(findDigest(line));
    }
    begins = line.back() == '\n';
  }
  std::sort(digests.begin(), digests.end());
  return digests;
}

void insert(std::uint64_t digest, std::vector<std::uint64_t>& digests) {
  digests.insert(std::upper_bound(digests.begin(), digests.end(), digest), digest);
}

}  // namespace

bool TrackHistory::contains(const std::string& digest) {
  if (!digests_) {
    digests_ = readDigests(file_);
  }
  return std::binary_search(digests_->begin(), digests_->end(), readDigest(digest));
}

void TrackHistory::add(const TrackRecord& record) {
  const std::string line = writeRecord(record) + "\n";
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(file_.c_str(), "ab"), &std::fclose);
  if (!file || std::fwrite(line.data(), 1, line.size(), file.get()) != line.size() ||
      std::fflush(file.get()) != 0) {
    std::error_code ignored;
    std::filesystem::resize_file(file_, bytes_, ignored);  // no half of a line stays
    throw std::runtime_error(file_.string() + ": cannot be written");
  }
  bytes_ += line.size();
  if (digests_) {
    insert(readDigest(record.digest), *digests_);
  }
}

std::vector<TrackRecord> TrackHistory::read(Index parameters, Index conditions) const {
  std::vector<TrackRecord> records;
  if (bytes_ == 0) {
    return records;
  }
  std::istringstream lines(readBytes(file_));
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    try {
      records.push_back(readRecord(line, parameters, conditions));
    } catch (const std::runtime_error& error) {
      throw std::runtime_error(fmt::format("{}:{}: {}", file_.string(), number, error.what()));
    }
  }
  std::stable_sort(records.begin(), records.end(),
                   [](const TrackRecord& one, const TrackRecord& other) { return one.isBefore(other); });
  return records;
}

TrackCourse calcTrackCourse(std::vector<TrackRecord> records, const tracking::Model& model) {
  std::vector<tracking::Measurement> measurements;
  for (const TrackRecord& record : records) {
    measurements.push_back(record.measurement);
  }
  return {std::move(records), calcWholeCourse(model, measurements)};
}

namespace {

/// "mean,sd,lower,upper" in the parameter's unit; the interval is of 95 %.
void addBand(const TrackSpace& space, Index j, const tracking::Course& course, Index n, CsvRow& row) {
  const double mean = course.means(j, n), stddev = course.stddevs(j, n);
  const double value = space.toValue(j, mean);
  for (const double number :
       {value, stddev / space.calcSlope(j, value), space.toValue(j, mean - kNormal95 * stddev),
        space.toValue(j, mean + kNormal95 * stddev)}) {
    row.push_back(fmt::format("{}", number));
  }
}

}  // namespace

std::string makeTrackCsv(const TrackCourse& course, const std::vector<ParameterSpec>& parameters,
                         const TrackSpace& space) {
  std::vector<CsvRow> rows{{"time", "source", "status", "used", "parameter", "unit", "mean", "sd", "lower",
                            "upper", "smoothed_mean", "smoothed_sd", "smoothed_lower", "smoothed_upper"}};
  for (std::size_t i = 0; i < course.records.size(); ++i) {
    const TrackRecord& record = course.records[i];
    for (std::size_t p = 0; p < parameters.size(); ++p) {
      const auto j = static_cast<Index>(p), n = static_cast<Index>(i);
      rows.push_back({fmt::format("{}", record.measurement.time), record.source, record.status,
                      course.whole.used[i] ? "yes" : "no", parameters[p].name.text, parameters[p].unit});
      addBand(space, j, course.whole.filtered, n, rows.back());
      addBand(space, j, course.whole.smoothed, n, rows.back());
    }
  }
  return makeCsv(rows);
}

}  // namespace twinmap
