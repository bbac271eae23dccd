#pragma once

#include <string_view>

namespace twinmap {

/// The cells of a line, one after another, without blanks and quotes around them.
class CsvCells {
 public:
  /// separator: ' ' stands for any number of blanks and tabs.
  CsvCells(std::string_view line, char separator);

  /// The next cell; false after the last one.
  bool next(std::string_view& cell);

 private:
  std::string_view rest_;
  char separator_;
  bool more_ = true;
};

/// The commonest of comma, semicolon, tab and bar outside quotes.
char findSeparator(std::string_view header);

/// Without blanks around it.
std::string_view trimBlanks(std::string_view text);

}  // namespace twinmap
