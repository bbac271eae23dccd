#include "framework/inference/joint/recording_list.hpp"

#include <fmt/format.h>

#include "framework/base/text/number_text.hpp"

namespace twinmap {
namespace {

std::vector<std::optional<double>> listStarts(const RecordedWindows& windows, const MeasurementReader& reader,
                                              const Table& table) {
  if (windows.every) {
    const std::optional<double> first =
        windows.starts.empty() ? std::nullopt : std::optional<double>(windows.starts.front());
    const std::vector<double> starts = reader.listWindows(table, first, *windows.every);
    return {starts.begin(), starts.end()};
  }
  if (windows.starts.empty()) {
    return {std::nullopt};
  }
  return {windows.starts.begin(), windows.starts.end()};
}

}  // namespace

RecordingList::RecordingList(const JointInferrer& inferrer, std::vector<RecordedTable> tables,
                             const RecordedWindows& windows)
    : tables_(std::move(tables)) {
  for (const RecordedTable& one : tables_) {
    const MeasurementReader& reader = inferrer.getReader(one.trial);
    for (const std::optional<double>& start : listStarts(windows, reader, one.table)) {
      add(one, start, windows.every || windows.starts.size() > 1);
    }
  }
}

void RecordingList::add(const RecordedTable& table, std::optional<double> start, bool is_one_of_several) {
  std::string label = table.trial.empty() ? table.name : table.trial;
  if (start && is_one_of_several) {
    label += "@" + toShortText(*start, 6) + "s";
  }
  std::string unique = label;
  for (int repeat = 2; !labels_.insert(unique).second; ++repeat) {
    unique = fmt::format("{}[{}]", label, repeat);
  }
  recordings_.push_back({unique, table.trial, &table.table, start});
}

}  // namespace twinmap
