#include "framework/experiment/yaml/yaml_layout.hpp"

#include <sstream>
#include <vector>

namespace twinmap {
namespace {

/// A column (from 0) at which keys or items of an open map or list begin.
struct Level {
  std::size_t column;
  int line;
  bool is_item;
};

bool isItem(const std::string& text, std::size_t column) {
  return text[column] == '-' && (column + 1 == text.size() || text[column + 1] == ' ');
}

std::string nameLine(const Level& level) {
  return "line " + std::to_string(level.line + 1) + " (column " + std::to_string(level.column + 1) + ")";
}

/// The levels that are open at a line, the deepest last.
class Levels {
 public:
  /// Ends those right of a column; returns the leftmost of them, or null.
  const Level* closeRightOf(std::size_t column) {
    const Level* last = nullptr;
    while (!open_.empty() && open_.back().column > column) {
      closed_ = open_.back();
      last = &closed_;
      open_.pop_back();
    }
    return last;
  }

  /// Takes a line that begins at a column; the key behind a '-' has a column of its own.
  void read(const std::string& text, std::size_t column, int line) {
    closeRightOf(column);
    if (open_.empty() || open_.back().column < column) {
      open_.push_back({column, line, isItem(text, column)});
    }
    open_.back().line = line;
    const std::size_t behind = isItem(text, column) ? text.find_first_not_of(' ', column + 1) : text.npos;
    if (behind != text.npos && text[behind] != '{' && text[behind] != '[') {
      read(text, behind, line);
    }
  }

  const Level* getDeepest() const { return open_.empty() ? nullptr : &open_.back(); }

 private:
  std::vector<Level> open_;
  Level closed_ = {};
};

/// Of a line that stands where the one before it does.
std::string describeMixed(const std::string& text, std::size_t column, const Level& level) {
  if (level.is_item == isItem(text, column)) {
    return "";
  }
  return level.is_item ? "a key stands among the items of a list, " + nameLine(level) +
                             ": begin it with '- ', or indent it like the keys of its item"
                       : "an item of a list stands among the keys of a map, " + nameLine(level) +
                             ": leave its '- ' out, or indent it below its key";
}

std::string describe(const std::string& text, std::size_t column, Levels& levels, bool has_value) {
  const Level* right = levels.closeRightOf(column);
  const Level* left = levels.getDeepest();
  if (!left) {
    return right ? "the line stands further left than any before it: indent it like " + nameLine(*right) : "";
  }
  if (left->column == column && has_value) {
    if (const std::string mixed = describeMixed(text, column, *left); !mixed.empty() && !right) {
      return mixed;
    }
  }
  if (left->column == column) {
    return !right || left->is_item || !isItem(text, column) || !right->is_item
               ? ""
               : "the item stands beside the keys of " + nameLine(*left) + ": indent it like " +
                     nameLine(*right);
  }
  if (right) {
    return "the line begins at column " + std::to_string(column + 1) +
           ", between two levels: indent it like " + nameLine(*right) + " or like " + nameLine(*left);
  }
  return has_value ? "the line stands further right than the one before it, which has its value already: "
                     "indent it like " +
                         nameLine(*left)
                   : "";
}

}  // namespace

std::string describeLayout(const std::string& text, int line) {
  std::istringstream lines(text);
  std::string found;
  Levels levels;
  bool has_value = false;
  for (int i = 0; std::getline(lines, found); ++i) {
    found.erase(found.find_last_not_of(" \r") + 1);
    const std::size_t column = found.find_first_not_of(' ');
    if (column == found.npos || found[column] == '#') {
      continue;
    }
    if (i >= line) {
      return i == line ? describe(found, column, levels, has_value) : "";
    }
    levels.read(found, column, i);
    has_value = found.back() != ':';
  }
  return "";
}

}  // namespace twinmap
