#pragma once

#include <string>

#include "framework/report/vega.hpp"

namespace twinmap {

/// A heat map of `rows` rows with its numbers written in, so that it reads without colour. `light_text`: an
/// expression of Vega, true where the cell is dark. `format`: d3's, of
/// the numbers.
Json makeHeatSpec(const std::string& table, int rows, const Json& x, const Json& y, const Json& color,
                  const std::string& value, const std::string& light_text, const std::string& format);

/// The colour of a number between -1 and 1, pale at 0.
Json makeSignedColor(const std::string& field);

}  // namespace twinmap
