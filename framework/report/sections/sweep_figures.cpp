#include "framework/report/sections/sweep_figures.hpp"

#include "framework/report/vega.hpp"
#include "framework/spec/yaml/number_text.hpp"

namespace twinmap {
namespace {

Choice makeChoice(const std::string& name, const std::string& label, const std::vector<std::string>& values) {
  Choice choice{name, label, {}, 0};
  for (const std::string& value : values) {
    choice.options.push_back({value, value.empty() ? "as in the file" : value, nullptr});
  }
  return choice;
}

std::vector<std::string> toTexts(const std::vector<double>& values) {
  std::vector<std::string> texts;
  for (const double value : values) {
    texts.push_back(toText(value));
  }
  return texts;
}

Json makeLimitLine(const Json& x, const std::string& y_title, const std::string& series) {
  return {{"transform", {{{"filter", "isValid(datum.limit_pct)"}}}},
          {"mark", {{"type", "line"}, {"strokeWidth", 1}, {"color", "var(--ink)"}, {"strokeDash", {2, 2}}}},
          {"encoding",
           {{"x", x},
            {"y", makeQuantitative("limit_pct", y_title, makeLogScale())},
            {"detail", {{"field", series}, {"type", "nominal"}}}}}};
}

/// sd over `x` for one parameter: a line per variant, or per value of `other` if there is one variant only.
Panel makeCurves(const SweepAxes& axes, const std::string& parameter, const std::string& x,
                 const std::string& x_title, const std::string& other, const std::vector<double>& others) {
  const std::string y_title = "sd of the relative error [%]";
  const bool by_variant = axes.variants.size() > 1;
  const std::string series = by_variant ? "variant" : other;
  const std::vector<std::string> names = by_variant ? axes.variants : toTexts(others);
  Json spec = makePanelSpec(kSweepTable, 180);
  spec.erase("params");
  spec["title"] = parameter;
  spec["transform"] = {{{"filter", {{"field", "parameter"}, {"equal", parameter}}}}};
  if (by_variant && !others.empty()) {
    spec["transform"].push_back({{"filter", "'' + datum['" + other + "'] == '{other}'"}});
  }
  if (!by_variant) {
    spec["transform"].push_back(
        {{"calculate", "isValid(datum['" + other + "']) ? '' + datum['" + other + "'] : 'all'"},
         {"as", other}});
  }
  const Json encode_x = makeQuantitative(x, x_title, makeLogScale());
  const Json color = makeNominal(series,
                                 by_variant         ? ""
                                 : other == "noise" ? "noise scale"
                                                    : "training samples",
                                 others.empty() && !by_variant ? Json::object() : makeColorScale(names));
  Json dash = color;
  dash["scale"] = makeDashScale(names)["scale"];
  const Json y = makeQuantitative("sd_pct", y_title, makeLogScale());
  const Json tooltip = {makeNominal(series, series),
                        makeQuantitative(x, x_title),
                        makeQuantitative("sd_pct", "mean sd [%]", {{"format", ".3~g"}}),
                        makeQuantitative("lowest", "lowest seed", {{"format", ".3~g"}}),
                        makeQuantitative("highest", "highest seed", {{"format", ".3~g"}}),
                        makeQuantitative("limit_pct", "limit [%]", {{"format", ".3~g"}}),
                        makeQuantitative("seeds", "seeds")};
  spec["layer"] = {{{"mark", {{"type", "area"}, {"opacity", 0.15}}},
                    {"encoding",
                     {{"x", encode_x},
                      {"y", makeQuantitative("lowest", y_title, makeLogScale())},
                      {"y2", {{"field", "highest"}}},
                      {"color", color}}}},
                   {{"mark", {{"type", "line"}, {"strokeWidth", 1.6}}},
                    {"encoding", {{"x", encode_x}, {"y", y}, {"color", color}, {"strokeDash", dash}}}},
                   {{"mark", {{"type", "point"}, {"filled", true}, {"size", 35}}},
                    {"encoding", {{"x", encode_x}, {"y", y}, {"color", color}, {"tooltip", tooltip}}}}};
  if (axes.has_limits) {
    spec["layer"].push_back(makeLimitLine(encode_x, y_title, series));
  }
  return {y_title + " of " + parameter + " over " + x_title + ", logarithmic axes", spec};
}

Panel makeHeatMap(const std::string& parameter, int rows) {
  constexpr int kRowHeight = 30, kFrame = 20;
  Json spec = makePanelSpec(kSweepTable, kFrame + kRowHeight * rows);
  spec.erase("params");
  spec["title"] = parameter;
  spec["transform"] = {{{"filter", {{"field", "parameter"}, {"equal", parameter}}}},
                       {{"filter", "datum.variant == '{variant}'"}}};
  spec["encoding"] = {
      {"x",
       {{"field", "size"},
        {"type", "ordinal"},
        {"title", "training samples"},
        {"axis", {{"labelAngle", 0}}}}},
      {"y", {{"field", "noise"}, {"type", "ordinal"}, {"title", "noise scale"}, {"sort", "descending"}}}};
  spec["layer"] = {
      {{"mark", {{"type", "rect"}}},
       {"encoding",
        {{"color",
          makeQuantitative("sd_pct", "sd [%]",
                           {{"scale", {{"type", "log"}, {"scheme", "cividis"}}}, {"legend", nullptr}})}}}},
      {{"transform",
        {{{"joinaggregate",
           {{{"op", "min"}, {"field", "sd_pct"}, {"as", "least"}},
            {{"op", "max"}, {"field", "sd_pct"}, {"as", "most"}}}}}}},
       {"mark", {{"type", "text"}, {"fontSize", 11}}},
       {"encoding",
        {{"text", makeQuantitative("sd_pct", "", {{"format", ".2~g"}})},
         {"color",
          {{"condition",
            {{"test", "datum.sd_pct * datum.sd_pct < datum.least * datum.most"}, {"value", "#ffffff"}}},
           {"value", "#101010"}}}}}}};
  return {"Mean sd of the relative error of " + parameter + " over training samples and noise scale", spec};
}

}  // namespace

Figure makeCurveFigure(const SweepAxes& axes, bool over_size) {
  const std::string x_title = over_size ? "training samples" : "noise scale";
  const std::vector<double>& others = over_size ? axes.noises : axes.sizes;
  const std::string other = over_size ? "noise" : "size";
  Figure figure{
      over_size ? "error-over-size" : "error-over-noise",
      "Error against " + x_title,
      "Each line is the mean over the seeds, its band reaches from the lowest to the highest seed; dotted: "
      "the information limit, below which no map can come.",
      kSweepTable,
      {},
      {},
      2};
  for (const std::string& parameter : axes.parameters) {
    figure.panels.push_back(
        makeCurves(axes, parameter, over_size ? "size" : "noise", x_title, other, others));
  }
  if (axes.variants.size() > 1 && others.size() > 1) {
    figure.choices.push_back(
        makeChoice("other", over_size ? "noise scale" : "training samples", toTexts(others)));
  } else if (axes.variants.size() > 1 && others.size() == 1) {
    figure.choices.push_back(
        makeChoice("other", over_size ? "noise scale" : "training samples", toTexts(others)));
  }
  return figure;
}

Figure makeHeatMapFigure(const SweepAxes& axes) {
  Figure figure{
      "size-noise",
      "Size against noise",
      "The mean sd of the relative error in %: along a row the gain from more simulations, along a column "
      "the gain from better sensors.",
      kSweepTable,
      {},
      {},
      2};
  for (const std::string& parameter : axes.parameters) {
    figure.panels.push_back(makeHeatMap(parameter, static_cast<int>(axes.noises.size())));
  }
  figure.choices = {makeChoice("variant", "inverse map", axes.variants)};
  return figure;
}

Figure makeVariantFigure(const SweepAxes& axes) {
  constexpr int kRowHeight = 26, kFrame = 20;
  Figure figure{
      "variants",
      "Error of each variant",
      "The mean over the seeds, its bar from the lowest to the highest seed; the tick is the information "
      "limit.",
      kSweepTable,
      {},
      {},
      2};
  for (const std::string& parameter : axes.parameters) {
    const std::string title = "sd of the relative error [%]";
    Json spec = makePanelSpec(kSweepTable, kFrame + kRowHeight * static_cast<int>(axes.variants.size()));
    spec.erase("params");
    spec["title"] = parameter;
    spec["transform"] = {{{"filter", {{"field", "parameter"}, {"equal", parameter}}}}};
    spec["encoding"] = {{"y", makeNominal("variant", "", {{"sort", nullptr}})}};
    spec["layer"] = {
        {{"mark", {{"type", "rule"}, {"color", "var(--color-0)"}}},
         {"encoding", {{"x", makeQuantitative("lowest", title)}, {"x2", {{"field", "highest"}}}}}},
        {{"mark", {{"type", "point"}, {"filled", true}, {"size", 60}, {"color", "var(--color-0)"}}},
         {"encoding", {{"x", makeQuantitative("sd_pct", title)}}}}};
    if (axes.has_limits) {
      spec["layer"].push_back({{"mark", {{"type", "tick"}, {"color", "var(--ink)"}, {"thickness", 2}}},
                               {"encoding", {{"x", makeQuantitative("limit_pct", title)}}}});
    }
    figure.panels.push_back({title + " of " + parameter + " for each variant", spec});
  }
  return figure;
}

}  // namespace twinmap
