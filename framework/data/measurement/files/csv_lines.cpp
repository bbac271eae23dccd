#include "framework/data/measurement/files/csv_lines.hpp"

#include "framework/data/measurement/files/table.hpp"

namespace twinmap {

bool CsvLines::next(std::string_view& line) {
  if (!begun_) {
    begun_ = true;
    fill();
    skipByteOrderMark();
  }
  std::size_t end = buffer_.find('\n', at_);
  while (end == std::string::npos) {
    const std::size_t searched = buffer_.size() - at_;
    if (!fill()) {
      break;
    }
    end = buffer_.find('\n', searched);
  }
  if (end == std::string::npos && at_ == buffer_.size()) {
    return false;
  }
  ++number_;
  line = std::string_view(buffer_).substr(at_, end == std::string::npos ? end : end - at_);
  at_ = end == std::string::npos ? buffer_.size() : end + 1;
  if (!line.empty() && line.back() == '\r') {
    line.remove_suffix(1);
  }
  if (line.find('\0') != std::string_view::npos) {
    fail("has a NUL byte: is not text, or not in UTF-8");
  }
  return true;
}

/// Drops the lines that were given, and appends a block; false at the end of the stream.
bool CsvLines::fill() {
  constexpr std::size_t kBlock = std::size_t{1} << 15, kLongestLine = std::size_t{1} << 24;
  buffer_.erase(0, at_);
  at_ = 0;
  const std::size_t before = buffer_.size();
  if (before > kLongestLine) {
    fail("has a line of more than 16 MiB: is not a table of text");
  }
  buffer_.resize(before + kBlock);
  stream_.read(buffer_.data() + before, static_cast<std::streamsize>(kBlock));
  buffer_.resize(before + static_cast<std::size_t>(stream_.gcount()));
  if (stream_.bad()) {
    fail("cannot be read");
  }
  return buffer_.size() > before;
}

void CsvLines::skipByteOrderMark() {
  if (buffer_.rfind("\xff\xfe", 0) == 0 || buffer_.rfind("\xfe\xff", 0) == 0) {
    fail("is in UTF-16; save it in UTF-8");
  }
  at_ = buffer_.rfind("\xef\xbb\xbf", 0) == 0 ? 3 : 0;
}

void CsvLines::fail(const std::string& problem) const {
  throw MeasurementError(source_ + ":" + std::to_string(number_ + (number_ == 0 ? 1 : 0)) + ": " + problem);
}

}  // namespace twinmap
