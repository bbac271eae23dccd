#include "framework/base/text/source_location.hpp"

#include <fmt/core.h>

#include <algorithm>

namespace twinmap {
namespace {

bool isControl(unsigned char c) {
  constexpr unsigned char kSpace = 0x20, kDelete = 0x7f;
  return c < kSpace || c == kDelete;
}

/// On one line, harmless to a terminal, and of at most 80 bytes, cut between two UTF-8 characters.
std::string makeShowable(std::string text) {
  constexpr std::size_t kLongest = 80;
  constexpr unsigned kContinues = 0x80, kMask = 0xC0;
  std::replace_if(text.begin(), text.end(), isControl, ' ');
  if (text.size() <= kLongest) {
    return text;
  }
  std::size_t end = kLongest;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & kMask) == kContinues) {
    --end;
  }
  return text.substr(0, end) + "...";
}

std::string message(const SourceLocation& where, const std::string& value, const std::string& rule) {
  const std::string found = value.empty() ? std::string() : " '" + makeShowable(value) + "'";
  return toString(where) + ":" + found + " " + rule;
}

}  // namespace

std::string toString(const SourceLocation& where) {
  std::string text = where.file;
  if (where.line > 0) {
    text += fmt::format(":{}:{}", where.line, where.column);
  }
  if (!where.key_path.empty()) {
    text += (text.empty() ? "" : ": ") + where.key_path;
  }
  return text;
}

ExperimentError::ExperimentError(const SourceLocation& where, const std::string& value,
                                 const std::string& rule)
    : std::runtime_error(message(where, value, rule)),
      problem_(std::make_shared<InputProblem>(InputProblem{where, value, rule})) {}

}  // namespace twinmap
