#include "framework/tracking/recording_shelf.hpp"

#include <algorithm>
#include <filesystem>

#include "framework/base/files/digest.hpp"
#include "framework/data/measurement/files/read_table.hpp"
#include "framework/diagnosis/candidates/term_candidates.hpp"
#include "framework/tracking/measured_context.hpp"

namespace twinmap {
namespace {

std::size_t countNumbers(const Table& table) {
  std::size_t count = 0;
  for (const Column& column : table.columns) {
    count += static_cast<std::size_t>(column.values.size());
  }
  return count;
}

}  // namespace

void RecordingShelf::add(const MeasurementReader& reader, const Table& table, const TrackRecord& record) {
  constexpr std::size_t kMost = 48, kMostNumbers = std::size_t{1} << 21U;
  KeptTable kept{record.digest, record.measurement.time, record.start, {}};
  if (reader.getLayout().times.size() > 0) {
    kept.start = reader.getStart(table, record.start);
  }
  const double beside = kDelayMargin * reader.getExperiment().model.simulation.duration;
  kept.table = takeWindow(table, reader, record.start, beside);
  numbers_ += countNumbers(kept.table);
  tables_.push_back(std::move(kept));
  while (tables_.size() > kMost || numbers_ > kMostNumbers) {
    numbers_ -= countNumbers(tables_.front().table);
    tables_.pop_front();
  }
}

std::optional<KeptTable> RecordingShelf::find(const TrackRecord& record,
                                              const std::vector<std::string>& columns,
                                              MissingCells missing) const {
  const double time = record.measurement.time;
  const auto kept = std::find_if(tables_.begin(), tables_.end(), [&](const KeptTable& one) {
    return one.digest == record.digest && one.time == time;
  });
  if (kept != tables_.end()) {
    return *kept;
  }
  const bool is_there = record.is_file && std::filesystem::exists(record.source);
  if (!is_there || toHex(calcFileDigest(record.source)) != record.digest) {
    return {};
  }
  return KeptTable{record.digest, time, record.start, readTable(record.source, columns, missing)};
}

}  // namespace twinmap
