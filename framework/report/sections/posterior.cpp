#include <algorithm>
#include <cmath>

#include "framework/report/sections/sections.hpp"

namespace twinmap {
namespace {

constexpr const char* kPosterior = "posterior";

const std::vector<std::string>& getShownColumns() {
  static const std::vector<std::string> columns{
      "sample",     "posterior_mean", "posterior_stddev",     "map_mean",
      "map_stddev", "limit_stddev",   "effective_sample_size"};
  return columns;
}

DataTable makePosteriorTable(const CsvTable& posterior) {
  DataTable table;
  table.add("parameter", posterior.listTexts("parameter"));
  for (const std::string& column : getShownColumns()) {
    table.add(column, posterior.listNumbers(column));
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

}  // namespace

void addPosterior(const RunFolder& run, Section& section, Page& page) {
  if (run.posterior.empty()) {
    return;
  }
  page.tables[kPosterior] = makePosteriorTable(run.posterior);
  Figure figure{kPosterior,
                "Beside the exact posterior",
                "Circles: the estimator; crosses: the information limit. On the dashed line both agree with "
                "the posterior, which was sampled by simulation for these test samples.",
                kPosterior,
                {},
                {},
                0};
  const std::vector<ParameterSpec>& parameters = run.experiment.model.parameters;
  figure.columns = parameters.size() >= 4 ? 4 : 0;
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    const std::string& name = parameters[p].name.text;
    figure.panels.push_back({kPosterior,
                             {{"name", name}, {"label", makeLabel(parameters[p])}, {"color", getColor(p)}},
                             {{"largest", findLargestStddev(run.posterior, name)}}});
  }
  addFigure(std::move(figure), section);
}

}  // namespace twinmap
