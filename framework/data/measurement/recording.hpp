#pragma once

#include <list>
#include <string>
#include <vector>

#include "framework/data/measurement/files/table.hpp"
#include "framework/data/measurement/time_series.hpp"
#include "framework/experiment/measurement_spec.hpp"
#include "framework/simulation/response_layout.hpp"

namespace twinmap {

/// Rows of one clock, in the order of their times.
struct ClockedRows {
  std::string file, clock;  ///< what tells them from others
  double start = 0.0;       ///< s; its time that is the model's 0
  Table rows;
  Eigen::VectorXd times;  ///< s; 0 is the model's
};

/// A recording of one file or several, each column in the rows of its clock.
class RecordedColumns {
 public:
  /// Table and spec must outlive the object; start: the time in the table (s) that is the model's 0.
  RecordedColumns(const Table& table, const MeasurementSpec& spec, double start)
      : table_(table), spec_(spec), start_(start) {}

  /// Those that hold an output; sorted, rows without a time left out. Reads a file of its own. Throws
  /// MeasurementError.
  const ClockedRows& getRows(const std::string& output);

  /// What had to be done to the rows, a phrase each.
  std::vector<std::string> takeRemarks() { return std::move(remarks_); }

 private:
  bool hasColumn(const Table& rows, const std::string& output) const;
  ClockedRows sort(const Table& table, const TimeBase& base, const std::string& column);

  const Table& table_;
  const MeasurementSpec& spec_;
  const double start_;
  std::list<ClockedRows> known_;  // whose addresses stay
  std::vector<std::string> remarks_;
};

/// The samples of one column, those that are there.
struct Samples {
  Eigen::VectorXd times, values;
};

Samples takeSamples(const Eigen::VectorXd& times, const Eigen::VectorXd& values);

/// Those of an output of the layout, in its unit.
Samples readSamples(const ClockedRows& clocked, const MeasurementSpec& spec, const ResponseLayout& layout,
                    std::size_t output);

}  // namespace twinmap
