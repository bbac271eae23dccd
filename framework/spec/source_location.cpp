#include "framework/spec/source_location.hpp"

namespace twinmap {
namespace {

std::string message(const SourceLocation& where, const std::string& value, const std::string& rule) {
  const std::string found = value.empty() ? std::string() : " '" + value + "'";
  return toString(where) + ":" + found + " " + rule;
}

}  // namespace

std::string toString(const SourceLocation& where) {
  std::string text = where.file;
  if (where.line > 0) {
    text += ":" + std::to_string(where.line) + ":" + std::to_string(where.column);
  }
  if (!where.key_path.empty()) {
    text += (text.empty() ? "" : ": ") + where.key_path;
  }
  return text;
}

ExperimentError::ExperimentError(const SourceLocation& where, const std::string& value,
                                 const std::string& rule)
    : std::runtime_error(message(where, value, rule)) {}

}  // namespace twinmap
