#include <algorithm>

#include "framework/report/html.hpp"
#include "framework/report/sections/samples_table.hpp"
#include "framework/report/sections/sections.hpp"
#include "framework/report/sections/selected_responses.hpp"
#include "framework/report/vega.hpp"

namespace twinmap {
namespace {

constexpr int kHeight = 180;

/// What hovering over a sample shows: its index, its true parameters, and what was inferred of this one.
Json makeTooltip(const std::vector<ParameterSpec>& parameters, const std::string& name) {
  Json tooltip = Json::array({makeNominal("sample", "sample")});
  for (const ParameterSpec& parameter : parameters) {
    tooltip.push_back(makeQuantitative(getTrueColumn(parameter.name.text), "true " + makeLabel(parameter),
                                       {{"format", ".5~g"}}));
  }
  tooltip.push_back(makeQuantitative(getInferredColumn(name), "inferred " + name, {{"format", ".5~g"}}));
  tooltip.push_back(makeQuantitative(getStddevColumn(name), "its sd", {{"format", ".3~g"}}));
  tooltip.push_back(makeQuantitative(getScoreColumn(name), "error / sd", {{"format", ".3~g"}}));
  return tooltip;
}

Json makePoints(const std::string& color, const Json& encoding) {
  Json points{{"params", makeBrush()}, {"mark", {{"type", "point"}, {"filled", true}, {"color", color}}}};
  points["encoding"] = encoding;
  points["encoding"]["opacity"] = {{"condition", {{"test", kIsSelected}, {"value", 0.85}}}, {"value", 0.12}};
  points["encoding"]["size"] = {
      {"condition", {{"test", "selected && selected[datum.sample]"}, {"value", 60}}}, {"value", 14}};
  return points;
}

/// +-2 sd as a bar through each point.
Json makeBars(const std::string& color, const std::string& center, const std::string& stddev, const Json& x,
              const std::string& title) {
  return {{"transform",
           {{{"calculate", "datum['" + center + "'] - 2 * datum['" + stddev + "']"}, {"as", "low"}},
            {{"calculate", "datum['" + center + "'] + 2 * datum['" + stddev + "']"}, {"as", "high"}}}},
          {"mark", {{"type", "rule"}, {"color", color}}},
          {"encoding",
           {{"x", x},
            {"y", makeQuantitative("low", title)},
            {"y2", {{"field", "high"}}},
            {"opacity", {{"condition", {{"test", kIsSelected}, {"value", 0.35}}}, {"value", 0.05}}}}}};
}

Json makeReferenceLine(const Json& values) {
  return {{"data", {{"values", values}}},
          {"mark", {{"type", "line"}, {"color", "var(--quiet)"}, {"strokeDash", {4, 3}}, {"strokeWidth", 1}}},
          {"encoding",
           {{"x", {{"field", "x"}, {"type", "quantitative"}}},
            {"y", {{"field", "y"}, {"type", "quantitative"}}}}}};
}

/// True against inferred, or true against the error.
Panel makePanel(const RunFolder& run, std::size_t p, bool of_error) {
  const std::vector<ParameterSpec>& parameters = run.experiment.model.parameters;
  const ParameterSpec& parameter = parameters[p];
  const std::string& name = parameter.name.text;
  const Bounds& bounds = parameter.bounds;
  const std::string title = (of_error ? "error of " : "inferred ") + makeLabel(parameter);
  const std::string column = of_error ? getErrorColumn(name) : getInferredColumn(name);
  const Json x = makeQuantitative(getTrueColumn(name), "true " + makeLabel(parameter),
                                  makeDomain(bounds.lower, bounds.upper));
  const Json y = makeQuantitative(column, title, makeFreeScale());
  const double low = of_error ? 0.0 : bounds.lower, high = of_error ? 0.0 : bounds.upper;
  Json spec = makePanelSpec("samples", kHeight);
  spec["layer"] = {makeReferenceLine({{{"x", bounds.lower}, {"y", low}}, {{"x", bounds.upper}, {"y", high}}}),
                   makeBars(getColor(p), column, getStddevColumn(name), x, title),
                   makePoints(getColor(p), {{"x", x}, {"y", y}, {"tooltip", makeTooltip(parameters, name)}})};
  return {title + " over the true value, one point per test sample, bars of 2 standard deviations", spec};
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
