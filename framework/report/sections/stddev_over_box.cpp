#include <algorithm>

#include "framework/report/sections/samples_table.hpp"
#include "framework/report/sections/sections.hpp"

namespace twinmap {
namespace {

// {x}, {y} and {p} stand for the parameters that the reader chooses.

/// A point per test sample at its true parameters, coloured and sized by a value; the value is listed first.
Panel makeBoxPanel(const std::string& column, const std::string& title, const std::string& tooltip) {
  return {"stddev", {{"column", column}, {"title", title}, {"what", tooltip}}, makeChosenDomains()};
}

std::size_t chooseParameter(const std::vector<ParameterSpec>& parameters, const ReportSpec& report,
                            std::size_t axis, std::size_t otherwise) {
  for (std::size_t p = 0; p < parameters.size() && axis < report.over.size(); ++p) {
    if (parameters[p].name.text == report.over[axis].text) {
      return p;
    }
  }
  return otherwise;
}

bool hasLimits(const RunFolder& run) {
  const auto is_known = [&](const ParameterSpec& parameter) {
    return !collectPredictions(run, parameter.name.text).limit_stddev.empty();
  };
  const std::vector<ParameterSpec>& parameters = run.experiment.model.parameters;
  return std::all_of(parameters.begin(), parameters.end(), is_known);
}

}  // namespace

void addStddevOverBox(const RunFolder& run, Page& page) {
  const std::vector<ParameterSpec>& parameters = run.experiment.model.parameters;
  if (run.predictions.empty() || parameters.size() < 2) {
    return;
  }
  const bool has_limits = hasLimits(run);
  const ReportSpec& report = run.experiment.report;
  Figure figure;
  figure.name = "stddev";
  figure.table = "samples";
  figure.title = "Where within the bounds are the estimates uncertain?";
  figure.help = std::string(
                    "One point per test sample at its true parameters: where the points of the first "
                    "panel are dark, the sd is small; the error beside it should be large only where the "
                    "stated sd is") +
                (has_limits ? ", and the limit shows what no method can beat." : ".");
  figure.choices = {makeParameterChoice("p", "of", parameters, 0),
                    makeParameterChoice("x", "across", parameters,
                                        chooseParameter(parameters, report, 0, parameters.size() - 2)),
                    makeParameterChoice("y", "up", parameters,
                                        chooseParameter(parameters, report, 1, parameters.size() - 1))};
  figure.panels = {makeBoxPanel(getStddevColumn("{p}"), "Stated sd of {p.label}", "stated sd"),
                   makeBoxPanel(getErrorColumn("{p}"), "Absolute error of {p.label}", "absolute error")};
  if (has_limits) {
    figure.panels.push_back(makeBoxPanel(getLimitColumn("{p}"), "Smallest possible sd of {p}", "limit"));
  }
  figure.columns = static_cast<int>(figure.panels.size());
  Section section{"stddev-over-box", "Standard deviation over the bounds", "", {}};
  addFigure(std::move(figure), section);
  page.sections.push_back(std::move(section));
}

}  // namespace twinmap
