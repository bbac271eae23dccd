#pragma once

#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <variant>
#include <vector>

namespace twinmap {

struct ParameterSpec;

/// Texts that stand for "{key}" in the strings of a skeleton.
using Texts = std::map<std::string, std::string>;

/// What stands in a slot: null, a number, a text, a list of texts, or the slot's example once for each of a
/// list of texts.
using SlotValue =
    std::variant<std::nullptr_t, double, std::string, std::vector<std::string>, std::vector<Texts>>;

/// One drawing of a figure: a skeleton and what fills it. A skeleton (web/figures/NAME.json) is a Vega-Lite
/// specification with examples in the places that differ between panels: "usermeta": {"slots": {..}} lists
/// the JSON pointers of each such place by name, its "datasets" are example rows of the page's tables, and
/// its "description" says what a reader who cannot see the drawing should know.
struct Panel {
  std::string skeleton;  ///< NAME
  Texts texts = {};      ///< "{key}" without a text is a choice of the reader (Choice)
  std::map<std::string, SlotValue> values = {};  ///< by slot; slots without a value keep their example
  std::set<std::string> without = {};            ///< slots that this panel lacks
};

/// The colour of a parameter, the same in every figure (report.css): Okabe and Ito's, safe for the colour
/// blind.
std::string getColor(std::size_t index);

/// "k_y [N/m]".
std::string makeLabel(const std::string& name, const std::string& unit);
std::string makeLabel(const ParameterSpec& parameter);

/// Pixels of `rows` rows, each `row_height`, and what surrounds them.
constexpr double calcHeight(std::size_t rows, int row_height, int frame) {
  return static_cast<double>(frame + row_height * static_cast<int>(rows));
}
constexpr double calcHeatHeight(std::size_t rows) {
  constexpr int kRowHeight = 26, kFrame = 10;  // a number of 11 pixels in each cell
  return calcHeight(rows, kRowHeight, kFrame);
}

}  // namespace twinmap
