#include <algorithm>

#include "framework/experiment/check/known_names.hpp"
#include "framework/report/sections/sections.hpp"
#include "framework/store/trained_file.hpp"

namespace twinmap {

void addRelevance(const RunFolder& run, Section& section, Page& page) {
  const std::vector<Eigen::VectorXd> length_scales =
      run.map ? run.map->model.map->listLengthScales() : std::vector<Eigen::VectorXd>();
  if (length_scales.empty() || length_scales[0].size() < 2) {
    return;
  }
  constexpr Eigen::Index kMaxInputs = 24;
  std::vector<std::string> parameters, inputs;
  std::vector<double> relevance, length_scale;
  const std::vector<std::string> names = collectNames(run.experiment.model.parameters);
  for (std::size_t p = 0; p < std::min(names.size(), length_scales.size()); ++p) {
    const Eigen::VectorXd& scales = length_scales[p];
    for (Eigen::Index i = 0; i < std::min(scales.size(), kMaxInputs); ++i) {
      parameters.push_back(names[p]);
      inputs.push_back(std::to_string(i + 1));
      length_scale.push_back(scales[i]);
      relevance.push_back(scales.minCoeff() / scales[i]);
    }
  }
  DataTable table;
  table.add("parameter", parameters);
  table.add("input", inputs);
  table.add("length_scale", length_scale);
  table.add("relevance", relevance);
  page.tables["relevance"] = table;
  addFigure({"relevance",
             "Relevance of the inputs",
             "The shortest length scale of a parameter's process over that of each input: 1 for the input on "
             "which the parameter depends most sharply, near 0 for one that hardly matters.",
             "relevance",
             {{"relevance", {}, {{"height", calcHeatHeight(names.size())}}}},
             {},
             1},
            section);
}

void addCorrelations(const RunFolder& run, Section& section, Page& page) {
  if (run.correlations.empty()) {
    return;
  }
  std::vector<std::string> a, b;
  std::vector<double> correlation;
  const std::vector<std::string> names = collectNames(run.experiment.model.parameters);
  for (std::size_t row = 0; row < run.correlations.rows.size(); ++row) {
    for (const std::string& name : names) {
      a.push_back(run.correlations.getText(row, "parameter"));
      b.push_back(name);
      correlation.push_back(run.correlations.getNumber(row, name));
    }
  }
  DataTable table;
  table.add("parameter", a);
  table.add("other", b);
  table.add("correlation", correlation);
  page.tables["correlations"] = table;
  addFigure({"correlations",
             "Correlation of the parameters",
             "How the data tie errors of two parameters together (from the mean Fisher information): near "
             "\u00b11 the response determines only a combination of them.",
             "correlations",
             {{"correlations", {}, {{"height", calcHeatHeight(names.size())}}}},
             {},
             1},
            section);
}

}  // namespace twinmap
