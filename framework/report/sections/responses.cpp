#include <fmt/core.h>

#include <algorithm>

#include "framework/report/html.hpp"
#include "framework/report/response_panels.hpp"
#include "framework/report/sections/sections.hpp"
#include "framework/store/samples_file.hpp"

namespace twinmap {
namespace {

constexpr const char* kResponses = "responses";

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

DataTable makeResponseTable(const CsvTable& responses) {
  DataTable table;
  for (const std::string& column : responses.columns) {
    if (column == "case" || column == "output") {
      table.add(column, responses.listTexts(column));
    } else {
      table.add(column, responses.listNumbers(column));
    }
  }
  return table;
}

ResponseData describeResponse(const RunFolder& run, const std::string& which, const std::string& output) {
  return {kResponses, output, findUnit(run, output), which};
}

}  // namespace

void addResponses(const RunFolder& run, Page& page) {
  const CsvTable& responses = run.responses;
  if (responses.empty()) {
    return;
  }
  page.tables[kResponses] = makeResponseTable(responses);
  const std::vector<std::string> outputs = responses.listDistinct("output");
  Section section{"responses", "Responses", "", {}};
  section.html = makeParagraph(
      "Three test samples, by their error (each parameter's in units of its root mean square over the test "
      "set).",
      "class=\"quiet\"");
  for (const std::string& which : responses.listDistinct("case")) {
    Figure figure{
        fmt::format("response-{}", section.figures.size()),
        "The " + which + " case, test sample " + findSample(responses, which),
        "Points: the measured response; dashed: the model at the centre of the box; solid: the model at "
        "the inferred parameters. Where the updated model is right, 95 % of the residuals lie in the grey "
        "band of \u00b12 noise sd.",
        kResponses,
        {},
        {},
        static_cast<int>(std::min<std::size_t>(outputs.size(), 3))};
    for (const std::string& output : outputs) {
      figure.panels.push_back(makeResponsePanel(describeResponse(run, which, output)));
    }
    for (const std::string& output : outputs) {
      figure.panels.push_back(makeResidualPanel(describeResponse(run, which, output)));
    }
    addFigure(std::move(figure), section);
  }
  page.sections.push_back(std::move(section));
}

}  // namespace twinmap
