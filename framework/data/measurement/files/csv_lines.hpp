#pragma once

#include <istream>
#include <string>
#include <string_view>

namespace twinmap {

/// The lines of a text, without line ends and a byte-order mark, read in large blocks: one pass, at most one
/// block and one line in memory.
class CsvLines {
 public:
  CsvLines(std::istream& stream, const std::string& source) : stream_(stream), source_(source) {}

  /// The next line, which stays until the next call; false at the end. Throws MeasurementError for what is no
  /// text: UTF-16, a NUL byte, a line of more than 16 MiB.
  bool next(std::string_view& line);

  /// Of the line that next() gave, from 1.
  std::size_t getNumber() const { return number_; }

 private:
  bool fill();
  void skipByteOrderMark();
  [[noreturn]] void fail(const std::string& problem) const;

  std::istream& stream_;
  const std::string& source_;
  std::string buffer_;
  std::size_t at_ = 0, number_ = 0;
  bool begun_ = false;
};

}  // namespace twinmap
