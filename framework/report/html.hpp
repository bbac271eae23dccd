#pragma once

#include <string>
#include <vector>

#include "framework/base/text/csv.hpp"
#include "framework/base/text/escape.hpp"

namespace twinmap {

/// <name attributes>content</name>; the content is HTML already.
inline std::string makeElement(const std::string& name, const std::string& content,
                               const std::string& attributes = "") {
  return "<" + name + (attributes.empty() ? "" : " " + attributes) + ">" + content + "</" + name + ">";
}

/// A paragraph of text.
inline std::string makeParagraph(const std::string& text, const std::string& attributes = "") {
  return makeElement("p", escapeHtml(text), attributes) + "\n";
}

/// What the page shows when its summary is pressed, and in print; both are HTML.
inline std::string makeFolded(const std::string& summary, const std::string& content) {
  return makeElement("details", makeElement("summary", summary) + "\n" + content) + "\n";
}

/// A cell of a table: what is shown, and the exact value by which it is sorted and copied.
struct HtmlCell {
  std::string shown;  ///< HTML
  std::string value;  ///< text; "": the shown text
  bool is_number = false;
};

HtmlCell makeTextCell(const std::string& text);
/// `exact`: a number as the files have it; shown rounded to `digits`, or to its standard error, which then
/// follows in parentheses (toTextWithError); "" is shown as a dash.
HtmlCell makeNumberCell(const std::string& exact, int digits = 4, const std::string& standard_error = "");

/// A table that the page sorts by the column whose heading is pressed. `headings` are texts.
std::string makeHtmlTable(const std::string& id, const std::string& caption,
                          const std::vector<std::string>& headings,
                          const std::vector<std::vector<HtmlCell>>& rows);

/// A column of a file as a table shows it.
struct ShownColumn {
  std::string name, heading;
  int digits = 4;
};

/// Its cells: texts as they are, numbers with their standard error where the file has it (NAME_se).
std::vector<HtmlCell> makeCells(const CsvTable& file, const ShownColumn& column);

/// Those columns of a file that it has.
std::string makeHtmlTable(const std::string& id, const std::string& caption, const CsvTable& file,
                          const std::vector<ShownColumn>& columns);

/// `first`, then kFigureColumns, then `last`.
std::vector<ShownColumn> showFigures(std::vector<ShownColumn> first,
                                     const std::vector<ShownColumn>& last = {});

/// Buttons that copy texts of the page, by name.
std::string makeCopyButtons(const std::vector<std::pair<std::string, std::string>>& names_and_labels);

}  // namespace twinmap
