#include "framework/robots/recording.hpp"

#include <algorithm>

namespace twinmap::robots {

const std::string* Recording::take(const std::string& name) {
  const auto found =
      std::find_if(columns.begin(), columns.end(), [&](const Column& column) { return column.name == name; });
  if (found == columns.end()) {
    return nullptr;
  }
  used.insert(found->text);
  return &found->text;
}

std::vector<std::string> Recording::listUnused() const {
  std::vector<std::string> unused;
  for (const Column& column : columns) {
    if (used.count(column.text) == 0) {
      unused.push_back(column.text);
    }
  }
  return unused;
}

std::string quote(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) {
    quoted += c == '\'' ? "''" : std::string(1, c);
  }
  return quoted + "'";
}

}  // namespace twinmap::robots
