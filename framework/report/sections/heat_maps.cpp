#include <algorithm>

#include "framework/report/sections/heat_spec.hpp"
#include "framework/report/sections/sections.hpp"
#include "framework/report/vega.hpp"
#include "framework/spec/check/check_experiment.hpp"

namespace twinmap {

void addRelevance(const RunFolder& run, Section& section, Page& page) {
  if (!run.map) {
    return;
  }
  constexpr Eigen::Index kMostInputs = 24;
  std::vector<std::string> parameters, inputs;
  std::vector<double> relevance, length_scale;
  const std::vector<std::string> names = collectNames(run.experiment.model.parameters);
  for (std::size_t p = 0; p < std::min(names.size(), run.map->hyperparameters.size()); ++p) {
    const Eigen::VectorXd& scales = run.map->hyperparameters[p].length_scales;
    for (Eigen::Index i = 0; i < std::min(scales.size(), kMostInputs); ++i) {
      parameters.push_back(names[p]);
      inputs.push_back(std::to_string(i + 1));
      length_scale.push_back(scales[i]);
      relevance.push_back(scales.minCoeff() / scales[i]);
    }
  }
  if (run.map->hyperparameters.empty() || run.map->hyperparameters[0].length_scales.size() < 2) {
    return;
  }
  DataTable table;
  table.add("parameter", parameters);
  table.add("input", inputs);
  table.add("length_scale", length_scale);
  table.add("relevance", relevance);
  page.tables["relevance"] = table;
  const Json x =
      makeNominal("input", "length scale of input", {{"sort", nullptr}, {"axis", {{"labelAngle", 0}}}});
  const Json y = makeNominal("parameter", "", {{"sort", nullptr}});
  const Json color = makeQuantitative("relevance", "shortest / length scale",
                                      {{"scale", {{"scheme", "viridis"}, {"domain", {0, 1}}}}});
  const Json spec = makeHeatSpec("relevance", static_cast<int>(names.size()), x, y, color, "relevance",
                                 "datum.relevance < 0.55", ".2~g");
  addFigure(
      {"relevance",
       "Relevance of the inputs",
       "The shortest length scale of a parameter's process over that of each input: 1 for the input on which "
       "the parameter depends most sharply, near 0 for one that hardly matters.",
       "relevance",
       {{"Relevance of each input for each parameter", spec}},
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
  const Json x = makeNominal("other", "", {{"sort", nullptr}, {"axis", {{"labelAngle", 0}}}});
  const Json y = makeNominal("parameter", "", {{"sort", nullptr}});
  const Json spec =
      makeHeatSpec("correlations", static_cast<int>(names.size()), x, y, makeSignedColor("correlation"),
                   "correlation", "abs(datum.correlation) > 0.6", ".2~f");
  addFigure({"correlations",
             "Correlation of the parameters",
             "How the data tie errors of two parameters together (from the mean Fisher information): near "
             "\u00b11 the "
             "response determines only a combination of them.",
             "correlations",
             {{"Correlation between each pair of parameters", spec}},
             {},
             1},
            section);
}

}  // namespace twinmap
