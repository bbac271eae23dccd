#include <algorithm>

#include "framework/report/html.hpp"
#include "framework/report/sections/sections.hpp"
#include "framework/report/vega.hpp"

namespace twinmap {
namespace {

constexpr const char* kTable = "responses";

/// The distinct texts of a column, in their order.
std::vector<std::string> collectDistinct(const CsvTable& table, const std::string& column) {
  std::vector<std::string> distinct;
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    const std::string& text = table.getText(row, column);
    if (std::find(distinct.begin(), distinct.end(), text) == distinct.end()) {
      distinct.push_back(text);
    }
  }
  return distinct;
}

std::string findUnit(const RunFolder& run, const std::string& output) {
  for (std::size_t i = 0; run.test_responses && i < run.test_responses->output_names.size(); ++i) {
    if (run.test_responses->output_names[i] == output) {
      return run.test_responses->output_units[i];
    }
  }
  return "";
}

std::string findSample(const CsvTable& responses, const std::string& which) {
  for (std::size_t row = 0; row < responses.rows.size(); ++row) {
    if (responses.getText(row, "case") == which) {
      return responses.getText(row, "sample");
    }
  }
  return "";
}

DataTable makeTable(const CsvTable& responses) {
  DataTable table;
  for (const std::string& column : responses.columns) {
    if (column == "case" || column == "output") {
      std::vector<std::string> texts;
      for (std::size_t row = 0; row < responses.rows.size(); ++row) {
        texts.push_back(responses.getText(row, column));
      }
      table.add(column, std::move(texts));
      continue;
    }
    std::vector<double> numbers;
    for (std::size_t row = 0; row < responses.rows.size(); ++row) {
      numbers.push_back(responses.getNumber(row, column));
    }
    table.add(column, std::move(numbers));
  }
  return table;
}

Json makeFilter(const std::string& which, const std::string& output) {
  return Json::array({{{"filter", {{"field", "case"}, {"equal", which}}}},
                      {{"filter", {{"field", "output"}, {"equal", output}}}}});
}

/// The same colour, shape and dash of each kind of response everywhere.
Json makeKind(const std::string& kind) {
  return {{"datum", kind},
          {"type", "nominal"},
          {"title", nullptr},
          {"scale",
           {{"domain", {"measured", "nominal", "updated"}},
            {"range", {"var(--ink)", "var(--color-1)", "var(--color-0)"}}}}};
}

Json makeLine(const char* column, const Json& dash, double width) {
  return {{"mark", {{"type", "line"}, {"strokeDash", dash}, {"strokeWidth", width}}},
          {"encoding", {{"y", {{"field", column}, {"type", "quantitative"}}}, {"color", makeKind(column)}}}};
}

Panel makeResponsePanel(const std::string& which, const std::string& output, const std::string& unit) {
  Json spec = makePanelSpec(kTable, 150);
  spec.erase("params");
  spec["transform"] = makeFilter(which, output);
  spec["encoding"] = {
      {"x", makeQuantitative("time", "time [s]")},
      {"y", {{"type", "quantitative"}, {"title", makeLabel(output, unit)}, {"scale", {{"zero", false}}}}}};
  const Json points{{"mark", {{"type", "point"}, {"filled", true}, {"size", 12}, {"opacity", 0.7}}},
                    {"encoding",
                     {{"y", {{"field", "measured"}, {"type", "quantitative"}}},
                      {"color", makeKind("measured")},
                      {"tooltip",
                       {makeQuantitative("time", "time [s]", {{"format", ".4~g"}}),
                        makeQuantitative("measured", "measured", {{"format", ".4~g"}}),
                        makeQuantitative("nominal", "nominal", {{"format", ".4~g"}}),
                        makeQuantitative("updated", "updated", {{"format", ".4~g"}})}}}}};
  spec["layer"] = {makeLine("nominal", {5, 3}, 1.2), makeLine("updated", {1, 0}, 1.6), points};
  return {"Measured, nominal and updated " + output + " over time, " + which + " case", spec};
}

Panel makeResidualPanel(const std::string& which, const std::string& output) {
  const std::string title = "residual / sd";
  Json spec = makePanelSpec(kTable, 70);
  spec.erase("params");
  spec["transform"] = makeFilter(which, output);
  spec["transform"].push_back(
      {{"calculate", "(datum.measured - datum.updated) / datum.noise_stddev"}, {"as", "residual"}});
  const Json band{{"data", {{"values", {{{"low", -2}, {"high", 2}}}}}},
                  {"mark", {{"type", "rect"}, {"color", "var(--quiet)"}, {"opacity", 0.15}}},
                  {"encoding", {{"y", makeQuantitative("low", title)}, {"y2", {{"field", "high"}}}}}};
  spec["layer"] = {
      band,
      {{"mark", {{"type", "point"}, {"filled", true}, {"size", 10}, {"color", "var(--color-0)"}}},
       {"encoding",
        {{"x", makeQuantitative("time", "time [s]")}, {"y", makeQuantitative("residual", title)}}}}};
  return {"Residual of " + output + " in units of noise over time, " + which + " case", spec};
}

}  // namespace

void addResponses(const RunFolder& run, Page& page) {
  const CsvTable& responses = run.responses;
  if (responses.empty()) {
    return;
  }
  page.tables[kTable] = makeTable(responses);
  const std::vector<std::string> outputs = collectDistinct(responses, "output");
  Section section{"responses", "Responses", "", {}};
  section.html = makeParagraph(
      "Three test samples, by their error (each parameter's in units of its root mean square over the test "
      "set).",
      "class=\"quiet\"");
  for (const std::string& which : collectDistinct(responses, "case")) {
    Figure figure{
        "response-" + std::to_string(section.figures.size()),
        "The " + which + " case, test sample " + findSample(responses, which),
        "Points: the measured response; dashed: the model at the centre of the box; solid: the model at "
        "the inferred parameters. Where the updated model is right, 95 % of the residuals lie in the grey "
        "band of \u00b12 noise sd.",
        kTable,
        {},
        {},
        static_cast<int>(std::min<std::size_t>(outputs.size(), 3))};
    for (const std::string& output : outputs) {
      figure.panels.push_back(makeResponsePanel(which, output, findUnit(run, output)));
    }
    for (const std::string& output : outputs) {
      figure.panels.push_back(makeResidualPanel(which, output));
    }
    addFigure(std::move(figure), section);
  }
  page.sections.push_back(std::move(section));
}

}  // namespace twinmap
