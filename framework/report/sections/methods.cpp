#include <algorithm>
#include <cmath>

#include "framework/report/html.hpp"
#include "framework/report/sections/metric_columns.hpp"
#include "framework/report/sections/sections.hpp"

namespace twinmap {
namespace {

constexpr const char* kMethods = "methods";

std::vector<std::string> listMethods(const CsvTable& methods) {
  std::vector<std::string> names;
  for (std::size_t row = 0; row < methods.rows.size(); ++row) {
    const std::string& name = methods.getText(row, "method");
    if (std::find(names.begin(), names.end(), name) == names.end()) {
      names.push_back(name);
    }
  }
  return names;
}

std::string makeMethodTable(const CsvTable& methods) {
  const std::vector<MetricColumn> columns{{"sd_pct", "sd %"},
                                          {"limit_pct", "limit %"},
                                          {"ratio_to_limit", "sd / limit"},
                                          {"coverage50", "coverage 50 %"},
                                          {"coverage90", "coverage 90 %"},
                                          {"coverage95", "coverage 95 %"},
                                          {"accepted", "share accepted"},
                                          {"median_simulations", "simulations, median"}};
  std::vector<std::string> headings{"method", "parameter"};
  for (const MetricColumn& column : columns) {
    headings.push_back(column.heading);
  }
  std::vector<std::vector<HtmlCell>> rows;
  for (std::size_t row = 0; row < methods.rows.size(); ++row) {
    rows.push_back(
        {makeTextCell(methods.getText(row, "method")), makeTextCell(methods.getText(row, "parameter"))});
    for (const MetricColumn& column : columns) {
      rows.back().push_back(makeNumberCell(methods.getText(row, column.name), kMetricDigits));
    }
  }
  return makeHtmlTable(
      "methods-table",
      "The figures of a method are those of the measurements that it accepted; the table above "
      "has what is answered by default.",
      headings, rows);
}

DataTable makeMethodData(const CsvTable& methods) {
  std::vector<std::string> method, parameter;
  std::vector<double> ratio, coverage;
  for (std::size_t row = 0; row < methods.rows.size(); ++row) {
    method.push_back(methods.getText(row, "method"));
    parameter.push_back(methods.getText(row, "parameter"));
    ratio.push_back(methods.getNumber(row, "ratio_to_limit"));
    coverage.push_back(methods.getNumber(row, "coverage95"));
  }
  DataTable table;
  table.add("method", method);
  table.add("parameter", parameter);
  table.add("ratio", ratio);
  table.add("coverage95", coverage);
  return table;
}

bool hasRatio(const CsvTable& methods) {
  for (std::size_t row = 0; row < methods.rows.size(); ++row) {
    if (std::isfinite(methods.getNumber(row, "ratio_to_limit"))) {
      return true;
    }
  }
  return false;
}

}  // namespace

void addMethods(const RunFolder& run, Page& page) {
  const CsvTable& methods = run.methods;
  if (methods.empty()) {
    return;
  }
  constexpr int kRowHeight = 28, kFrame = 20;
  Section section{"methods", "From the map to the answer", "", {}};
  section.html = makeMethodTable(methods);
  if (hasRatio(methods)) {
    const std::vector<std::string> names = listMethods(methods);
    const std::size_t parameters = methods.rows.size() / names.size();
    page.tables[kMethods] = makeMethodData(methods);
    addFigure(
        {"methods",
         "How near the limit each method comes",
         "On the dashed line a method is as good as the noise of the data allows any.",
         kMethods,
         {{"methods", {}, {{"height", calcHeight(parameters, kRowHeight, kFrame)}, {"methods", names}}}},
         {},
         1},
        section);
  }
  page.sections.push_back(std::move(section));
}

}  // namespace twinmap
