#include "framework/report/html.hpp"

#include <algorithm>

#include "framework/base/text/number_text.hpp"
#include "framework/base/text/number_with_error.hpp"
#include "framework/experiment/parameter_figures.hpp"

namespace twinmap {
namespace {

std::string makeHeading(const std::string& text, bool is_number) {
  return makeElement(
      "th", makeElement("button", escapeHtml(text), "type=\"button\""),
      std::string("scope=\"col\" aria-sort=\"none\"") + (is_number ? " class=\"number\"" : ""));
}

std::string makeCell(const HtmlCell& cell) {
  const std::string value = cell.value.empty() ? "" : "data-value=\"" + escapeHtml(cell.value) + "\"";
  constexpr std::size_t kShort = 24;  // rather widen the table than break a unit
  const bool is_short = !cell.is_number && cell.shown.size() <= kShort;
  return makeElement("td", cell.shown,
                     value + (cell.is_number ? " class=\"number\""
                              : is_short     ? " class=\"short\""
                                             : ""));
}

/// Whether every cell is a number, or empty, or one that is not known.
bool holdsNumbers(const std::vector<std::string>& texts) {
  double value = 0.0;
  return std::all_of(texts.begin(), texts.end(), [&](const std::string& text) {
    return text.empty() || text == "nan" || text == "-nan" || parseLiteral(text, value);
  });
}

}  // namespace

HtmlCell makeTextCell(const std::string& text) {
  return {escapeHtml(text), "", false};
}

HtmlCell makeNumberCell(const std::string& exact, int digits, const std::string& standard_error) {
  double value = 0.0, error = 0.0;
  if (!parseLiteral(exact, value)) {
    return {"\u2013", exact, true};
  }
  const bool has_error = parseLiteral(standard_error, error) && error > 0.0;
  return {has_error ? toTextWithError(value, error, digits) : toShortText(value, digits), exact, true};
}

std::string makeHtmlTable(const std::string& id, const std::string& caption,
                          const std::vector<std::string>& headings,
                          const std::vector<std::vector<HtmlCell>>& rows) {
  constexpr std::size_t kMaxRows = 40;  // longer tables scroll
  std::string html = makeElement("p", escapeHtml(caption), "class=\"caption\"") + "\n<div class=\"" +
                     (rows.size() > kMaxRows ? "scroll tall" : "scroll") +
                     "\" tabindex=\"0\"><table class=\"sortable\" id=\"" + escapeHtml(id) +
                     "\" aria-label=\"" + escapeHtml(caption) + "\">\n<thead><tr>";
  for (std::size_t i = 0; i < headings.size(); ++i) {
    html += makeHeading(headings[i], !rows.empty() && rows[0][i].is_number);
  }
  html += "</tr></thead>\n<tbody>\n";
  for (const std::vector<HtmlCell>& row : rows) {
    html += "<tr>";
    for (const HtmlCell& cell : row) {
      html += makeCell(cell);
    }
    html += "</tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

std::vector<HtmlCell> makeCells(const CsvTable& file, const ShownColumn& column) {
  const std::vector<std::string> texts = file.listTexts(column.name);
  const bool is_number = holdsNumbers(texts);
  std::vector<HtmlCell> cells;
  for (std::size_t row = 0; row < texts.size(); ++row) {
    cells.push_back(is_number
                        ? makeNumberCell(texts[row], column.digits, file.getText(row, column.name + "_se"))
                        : makeTextCell(texts[row]));
  }
  return cells;
}

std::string makeHtmlTable(const std::string& id, const std::string& caption, const CsvTable& file,
                          const std::vector<ShownColumn>& columns) {
  std::vector<std::string> headings;
  std::vector<std::vector<HtmlCell>> rows(file.rows.size());
  for (const ShownColumn& column : columns) {
    if (!file.hasColumn(column.name)) {
      continue;
    }
    headings.push_back(column.heading);
    const std::vector<HtmlCell> cells = makeCells(file, column);
    for (std::size_t row = 0; row < rows.size(); ++row) {
      rows[row].push_back(cells[row]);
    }
  }
  return makeHtmlTable(id, caption, headings, rows);
}

std::vector<ShownColumn> showFigures(std::vector<ShownColumn> first, const std::vector<ShownColumn>& last) {
  for (const FigureColumn& column : kFigureColumns) {
    first.push_back({column.name, column.heading});
  }
  first.insert(first.end(), last.begin(), last.end());
  return first;
}

std::string makeCopyButtons(const std::vector<std::pair<std::string, std::string>>& names_and_labels) {
  std::string html = "<p class=\"actions\">Copy as";
  for (const auto& [name, label] : names_and_labels) {
    html += " " + makeElement("button", escapeHtml(label),
                              "type=\"button\" data-copy=\"" + escapeHtml(name) + "\"");
  }
  return html + " <span class=\"said\" role=\"status\"></span></p>\n";
}

}  // namespace twinmap
