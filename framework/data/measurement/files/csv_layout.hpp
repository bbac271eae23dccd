#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace twinmap {

/// Where the names of the columns of a text table stand, and what is between its cells.
struct CsvLayout {
  std::size_t header = 0;  ///< of the lines that were looked at
  bool has_units = false;  ///< the line after the header states units
  char separator = ',';    ///< ' ': any number of blanks and tabs
};

/// Whether a cell is a number, with a decimal point or comma.
bool isCsvNumber(std::string_view cell);

/// The layout of a table, from its first lines without empty ones and comments (one or more). The header is
/// the first line; where the next has another number of cells, it is the first line of names that is followed
/// by numbers in as many cells: what stands above is a block of remarks. Names may be followed by a line of
/// units. Cells are separated by commas, semicolons, tabs or bars, whichever the header has most, or by
/// blanks where it has none of them and the next line has as many words.
CsvLayout findCsvLayout(const std::vector<std::string>& lines);

}  // namespace twinmap
