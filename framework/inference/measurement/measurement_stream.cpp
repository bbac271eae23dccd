#include "framework/inference/measurement/measurement_stream.hpp"

namespace twinmap {
namespace {

bool isBlank(const std::string& line) {
  return line.find_first_not_of(" \t\r") == std::string::npos;
}

}  // namespace

bool MeasurementStream::next(std::string& text) {
  text.clear();
  while (std::getline(stream_, line_)) {
    if (header_.empty() && !isBlank(line_)) {
      header_ = line_;
      continue;
    }
    const bool ends = isBlank(line_) || line_ == header_;
    if (ends && !text.empty()) {
      return true;
    }
    if (!ends) {
      if (text.empty()) {
        text.append(header_) += '\n';
      }
      text.append(line_) += '\n';
    }
  }
  return !text.empty();
}

}  // namespace twinmap
