#pragma once

#include <optional>
#include <string>

#include "framework/base/text/source_location.hpp"

namespace twinmap {

/// A column of a table of measurements, written "enc1 [mm]", or "enc1" where the unit is not stated.
struct ColumnSpec {
  std::string name;
  std::optional<std::string> unit;
  SourceLocation where;
};

/// The name, and the unit if the text ends in one within brackets; both without blanks around them. Round
/// brackets behind a blank hold one where UDUNITS-2 knows it: "Force (N)".
ColumnSpec parseColumn(const std::string& text, const SourceLocation& where = {});

/// "enc1 [mm]", or "enc1".
std::string toText(const ColumnSpec& column);

}  // namespace twinmap
