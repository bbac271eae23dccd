#include <algorithm>

#include "framework/report/html.hpp"
#include "framework/report/sections/samples_table.hpp"
#include "framework/report/sections/sections.hpp"
#include "framework/report/sections/selected_responses.hpp"

namespace twinmap {
namespace {

/// The true parameters, which hovering over a sample shows.
std::vector<Texts> listParameters(const std::vector<ParameterSpec>& parameters) {
  std::vector<Texts> listed;
  for (const ParameterSpec& parameter : parameters) {
    listed.push_back({{"each", parameter.name.text}, {"each_label", makeLabel(parameter)}});
  }
  return listed;
}

/// True against inferred, or true against the error.
Panel makePanel(const RunFolder& run, std::size_t p, bool of_error) {
  const std::vector<ParameterSpec>& parameters = run.experiment.model.parameters;
  const ParameterSpec& parameter = parameters[p];
  const std::string& name = parameter.name.text;
  const Bounds& bounds = parameter.bounds;
  const std::string title = (of_error ? "error of " : "inferred ") + makeLabel(parameter);
  const Texts texts{{"name", name},
                    {"label", makeLabel(parameter)},
                    {"title", title},
                    {"column", of_error ? getErrorColumn(name) : getInferredColumn(name)},
                    {"color", getColor(p)}};
  return {"estimates",
          texts,
          {{"lower", bounds.lower},
           {"upper", bounds.upper},
           {"line_start", of_error ? 0.0 : bounds.lower},
           {"line_end", of_error ? 0.0 : bounds.upper},
           {"parameters", listParameters(parameters)}}};
}

Figure makeFigure(const RunFolder& run, bool of_error) {
  const std::size_t count = run.experiment.model.parameters.size();
  Figure figure;
  figure.name = of_error ? "errors" : "inferred";
  figure.table = "samples";
  figure.title = of_error ? "Error against the true value" : "Inferred against true";
  figure.help = of_error
                    ? "Each bar spans \u00b12 sd around the error (inferred \u2212 true); where the map is "
                      "honest, about 95 % of the bars cross the dashed line at 0."
                    : describeDrawnSamples(run) +
                          "Points on the dashed line are inferred exactly; bars span \u00b12 sd. Drag over "
                          "points, or press one, to highlight the same samples in every figure.";
  figure.columns = count > 1 ? static_cast<int>(std::min<std::size_t>(count, 4)) : 0;
  figure.columns = count == 4 ? 2 : std::min(figure.columns, 3);
  for (std::size_t p = 0; p < count; ++p) {
    figure.panels.push_back(makePanel(run, p, of_error));
  }
  return figure;
}

}  // namespace

void addInferred(const RunFolder& run, Page& page) {
  if (run.predictions.empty()) {
    return;
  }
  Section section{"inferred", "True against inferred", "", {}};
  addFigure(makeFigure(run, false), section);
  addFigure(makeFigure(run, true), section);
  addSelectedResponses(run, section, page);
  page.sections.push_back(std::move(section));
}

}  // namespace twinmap
