#include <fmt/core.h>

#include <algorithm>

#include "framework/report/html.hpp"
#include "framework/report/response_panels.hpp"
#include "framework/report/sections/sections.hpp"
#include "framework/simulation/excitation/calc_input_signals.hpp"
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
  return {kResponses, output, findUnit(run, output), which, "test sample"};
}

/// The excitation signals over the time that is simulated; nothing of a model without.
void addExcitation(const RunFolder& run, Page& page, Section& section) {
  constexpr Eigen::Index kTimes = 1001;
  const ModelSpec& model = run.experiment.model;
  if (model.excitation.empty() || !(model.simulation.duration > 0.0)) {
    return;
  }
  const Eigen::VectorXd times = Eigen::VectorXd::LinSpaced(kTimes, 0.0, model.simulation.duration);
  const InputSignals signals = calcInputSignals(model, times);
  DataTable& table = page.tables["excitation"];
  table.add("time", std::vector<double>(times.begin(), times.end()));
  Figure figure{"excitation", "Excitation", "At the centre of the bounds.", "excitation", {}, {}, 0};
  for (std::size_t s = 0; s < signals.names.size(); ++s) {
    const auto values = signals.values.col(static_cast<Eigen::Index>(s));
    std::string column = "signal_" + signals.names[s];
    std::replace(column.begin(), column.end(), '.', '_');  // a picture would look for a part of a field
    table.add(column, std::vector<double>(values.begin(), values.end()));
    figure.panels.push_back({"signal",
                             {{"table", "excitation"},
                              {"column", column},
                              {"label", makeLabel(signals.names[s], signals.units[s])}}});
  }
  addFigure(std::move(figure), section);
}

}  // namespace

void addResponses(const RunFolder& run, Page& page) {
  const CsvTable& responses = run.responses;
  if (responses.empty()) {
    return;
  }
  page.tables[kResponses] = makeResponseTable(responses);
  const std::vector<std::string> outputs = responses.listDistinct("output");
  Section section{"responses", "Excitation and responses", "", {}};
  addExcitation(run, page, section);
  section.html += makeParagraph(
      "Three simulated test measurements: those with the smallest, the median and the largest error.",
      "class=\"quiet\"");
  int index = 0;
  for (const std::string& which : responses.listDistinct("case")) {
    Figure figure{
        fmt::format("response-{}", index++),
        "The " + which + " case, test sample " + findSample(responses, which),
        "Points: the simulated measurement; dashed: the model at the centre of the bounds; solid: the model "
        "at the estimated parameters. Where the updated model is right, 95 % of the residuals lie in the "
        "grey band of \u00b12 noise sd. Drag and scroll to move and zoom the axis of time.",
        kResponses,
        {},
        {},
        static_cast<int>(std::min<std::size_t>(outputs.size(), 2))};
    constexpr ResponseLook kLook{false, true};
    for (const std::string& output : outputs) {
      figure.panels.push_back(makeResponsePanel(describeResponse(run, which, output), kLook));
    }
    for (const std::string& output : outputs) {
      figure.panels.push_back(makeResidualPanel(describeResponse(run, which, output), kLook));
    }
    addFigure(std::move(figure), section);
  }
  page.sections.push_back(std::move(section));
}

}  // namespace twinmap
