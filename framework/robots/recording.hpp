#pragma once

#include <set>
#include <string>
#include <vector>

namespace twinmap::robots {

/// A table of measurements of a robot, as far as its experiment needs it: which columns there are, and when.
struct Recording {
  struct Column {
    std::string name, text;  ///< "shoulder", "shoulder [deg]"
  };

  std::string file;
  std::string time;                    ///< text of the column of times
  double first = 0.0, interval = 0.0;  ///< s
  int count = 0;
  std::vector<Column> columns;  ///< but times
  std::set<std::string> used{};

  /// The text of the column with this name, which is then used; nullptr: there is none.
  const std::string* take(const std::string& name);
  /// Texts of those that were not.
  std::vector<std::string> listUnused() const;
};

/// As a YAML text in quotes.
std::string quote(const std::string& text);

}  // namespace twinmap::robots
