#include <algorithm>
#include <cmath>

#include "framework/report/sections/sections.hpp"
#include "framework/report/vega.hpp"
#include "framework/spec/check/check_experiment.hpp"

namespace twinmap {
namespace {

constexpr const char* kTable = "posterior";

const std::vector<std::string>& getColumns() {
  static const std::vector<std::string> columns{
      "sample",     "posterior_mean", "posterior_stddev",     "map_mean",
      "map_stddev", "limit_stddev",   "effective_sample_size"};
  return columns;
}

DataTable makeTable(const CsvTable& posterior) {
  DataTable table;
  std::vector<std::string> parameters;
  for (std::size_t row = 0; row < posterior.rows.size(); ++row) {
    parameters.push_back(posterior.getText(row, "parameter"));
  }
  table.add("parameter", std::move(parameters));
  for (const std::string& column : getColumns()) {
    std::vector<double> values;
    for (std::size_t row = 0; row < posterior.rows.size(); ++row) {
      values.push_back(posterior.getNumber(row, column));
    }
    table.add(column, std::move(values));
  }
  return table;
}

double findLargestStddev(const CsvTable& posterior, const std::string& parameter) {
  double largest = 0.0;
  for (std::size_t row = 0; row < posterior.rows.size(); ++row) {
    if (posterior.getText(row, "parameter") == parameter) {
      for (const char* column : {"posterior_stddev", "map_stddev", "limit_stddev"}) {
        largest = std::fmax(largest, posterior.getNumber(row, column));
      }
    }
  }
  return largest;
}

Json makePoints(const char* column, const char* shape, const std::string& color, const Json& x,
                const std::string& y_title) {
  return {
      {"transform", {{{"filter", "isValid(datum." + std::string(column) + ")"}}}},
      {"mark", {{"type", "point"}, {"shape", shape}, {"size", 45}, {"color", color}, {"strokeWidth", 1.5}}},
      {"encoding",
       {{"x", x},
        {"y", makeQuantitative(column, y_title)},
        {"tooltip",
         {makeNominal("sample", "sample"),
          makeQuantitative("posterior_mean", "posterior mean", {{"format", ".5~g"}}),
          makeQuantitative("map_mean", "inferred", {{"format", ".5~g"}}),
          makeQuantitative("posterior_stddev", "posterior sd", {{"format", ".3~g"}}),
          makeQuantitative("map_stddev", "inferred sd", {{"format", ".3~g"}}),
          makeQuantitative("effective_sample_size", "effective sample size", {{"format", ".4~g"}})}}}}};
}

Panel makePanel(const CsvTable& posterior, const ParameterSpec& parameter, std::size_t p) {
  const std::string& name = parameter.name.text;
  const std::string y_title = "sd of the map, limit";
  const Json x = makeQuantitative("posterior_stddev", "sd of the posterior", makeFreeScale());
  const double largest = findLargestStddev(posterior, name);
  Json spec = makePanelSpec(kTable, 140);
  spec.erase("params");
  spec["title"] = makeLabel(parameter);
  spec["transform"] = {{{"filter", {{"field", "parameter"}, {"equal", name}}}}};
  const Json diagonal{
      {"data", {{"values", {{{"v", 0}}, {{"v", largest}}}}}},
      {"mark", {{"type", "line"}, {"color", "var(--quiet)"}, {"strokeDash", {4, 3}}, {"strokeWidth", 1}}},
      {"encoding",
       {{"x", makeQuantitative("v", "sd of the posterior")}, {"y", makeQuantitative("v", y_title)}}}};
  spec["layer"] = {diagonal, makePoints("limit_stddev", "cross", "var(--quiet)", x, y_title),
                   makePoints("map_stddev", "circle", getColor(p), x, y_title)};
  return {"Inferred sd and information limit of " + name + " against the sd of the exact posterior", spec};
}

}  // namespace

void addPosterior(const RunFolder& run, Section& section, Page& page) {
  if (run.posterior.empty()) {
    return;
  }
  page.tables[kTable] = makeTable(run.posterior);
  Figure figure{
      kTable,
      "Beside the exact posterior",
      "Circles: what the map infers; crosses: the information limit. On the dashed line both agree with the "
      "posterior, which was sampled by simulation for these test samples.",
      kTable,
      {},
      {},
      0};
  const std::vector<ParameterSpec>& parameters = run.experiment.model.parameters;
  figure.columns = parameters.size() >= 4 ? 4 : 0;
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    figure.panels.push_back(makePanel(run.posterior, parameters[p], p));
  }
  addFigure(std::move(figure), section);
}

}  // namespace twinmap
