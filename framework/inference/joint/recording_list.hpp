#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "framework/inference/joint/joint_inference.hpp"

namespace twinmap {

/// A table and the trial that it records ("" of an experiment without trials); name: what it is called.
struct RecordedTable {
  std::string trial, name;
  Table table;
};

/// Which parts of each table are recordings: one that begins where the experiment says, or those at `starts`;
/// or windows, one every so many seconds, from the first of `starts` on where there is one.
struct RecordedWindows {
  std::vector<double> starts{};
  std::optional<double> every{};  ///< s
};

/// The recordings of several tables, each with a label of its own: its trial or else its table's name, the
/// start behind it where there are several, "[2]" of a repeat. Throws MeasurementError, and ExperimentError
/// for an unknown trial.
class RecordingList {
 public:
  RecordingList(const JointInferrer& inferrer, std::vector<RecordedTable> tables,
                const RecordedWindows& windows);
  RecordingList(const RecordingList&) = delete;  // recordings point at the tables
  RecordingList& operator=(const RecordingList&) = delete;

  const std::vector<Recording>& get() const { return recordings_; }

 private:
  void add(const RecordedTable& table, std::optional<double> start, bool is_one_of_several);

  const std::vector<RecordedTable> tables_;
  std::vector<Recording> recordings_;
  std::set<std::string> labels_;
};

}  // namespace twinmap
