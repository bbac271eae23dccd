#pragma once

#include <istream>
#include <string>

namespace twinmap {

/// Cuts a stream of CSV tables, one measurement after another, into texts that readCsv() takes. The first
/// line names the columns of all; an empty line ends a measurement, and so does the line of names where it
/// stands again. So `cat a.csv b.csv` is a stream of two.
class MeasurementStream {
 public:
  explicit MeasurementStream(std::istream& stream) : stream_(stream) {}

  /// The next measurement, its line of names included; false at the end. Blocks until it is complete.
  bool next(std::string& text);

 private:
  std::istream& stream_;
  std::string header_, line_;
};

}  // namespace twinmap
