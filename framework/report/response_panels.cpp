#include "framework/report/response_panels.hpp"

#include "framework/report/vega.hpp"

namespace twinmap {
namespace {

Json makeSpec(const ResponseData& data, int height) {
  Json spec = makePanelSpec(data.table, height);
  spec.erase("params");
  spec["transform"] = data.transforms;
  return spec;
}

std::string makeAlt(const std::string& what, const ResponseData& data) {
  return what + (data.which.empty() ? "" : ", " + data.which);
}

Json makeKindScale(const Json& range) {
  return {{"domain", {"measured", "nominal", "updated"}}, {"range", range}};
}

Json makeKindChannel(const std::string& kind, const Json& range) {
  return {{"datum", kind}, {"type", "nominal"}, {"title", nullptr}, {"scale", makeKindScale(range)}};
}

/// The same colour of each kind of response everywhere.
Json makeColor(const std::string& kind) {
  return makeKindChannel(kind, {"var(--ink)", "var(--color-1)", "var(--color-0)"});
}

/// Points in the legend for what was measured, lines for the models.
Json makeShape(const std::string& kind) {
  return makeKindChannel(kind, {"circle", "stroke", "stroke"});
}

Json makeDash(const std::string& kind) {
  return makeKindChannel(kind, {getDash(0), Json::array({5, 3}), getDash(0)});
}

Json makeLine(const char* column, double width) {
  return {{"mark", {{"type", "line"}, {"strokeWidth", width}, {"clip", true}}},
          {"encoding",
           {{"y", {{"field", column}, {"type", "quantitative"}}},
            {"color", makeColor(column)},
            {"strokeDash", makeDash(column)}}}};
}

Json makeTooltip(const ResponseLook& look) {
  Json tooltip = Json::array({makeQuantitative("time", "time [s]", {{"format", ".4~g"}})});
  for (const char* column : {"measured", "nominal", "updated"}) {
    tooltip.push_back(makeQuantitative(column, column, {{"format", ".4~g"}}));
  }
  if (look.band) {
    tooltip.push_back(makeQuantitative("lower", "band from", {{"format", ".4~g"}}));
    tooltip.push_back(makeQuantitative("upper", "band to", {{"format", ".4~g"}}));
  }
  return tooltip;
}

Json makePoints(const ResponseLook& look) {
  return {{"mark", {{"type", "point"}, {"filled", true}, {"size", 12}, {"opacity", 0.7}, {"clip", true}}},
          {"encoding",
           {{"y", {{"field", "measured"}, {"type", "quantitative"}}},
            {"color", makeColor("measured")},
            {"shape", makeShape("measured")},
            {"tooltip", makeTooltip(look)}}}};
}

Json makeBand() {
  return {
      {"mark", {{"type", "area"}, {"color", "var(--color-0)"}, {"opacity", 0.25}, {"clip", true}}},
      {"encoding", {{"y", {{"field", "lower"}, {"type", "quantitative"}}}, {"y2", {{"field", "upper"}}}}}};
}

/// Dragging and scrolling move and scale the axis of time; a double click takes it back.
Json makeZoom() {
  return Json::array(
      {{{"name", "zoom"}, {"select", {{"type", "interval"}, {"encodings", {"x"}}}}, {"bind", "scales"}}});
}

}  // namespace

Panel makeResponsePanel(const ResponseData& data, const ResponseLook& look) {
  constexpr int kHeight = 150;
  Json spec = makeSpec(data, kHeight);
  spec["encoding"] = {{"x", makeQuantitative("time", "time [s]")},
                      {"y",
                       {{"type", "quantitative"},
                        {"title", makeLabel(data.output, data.unit)},
                        {"scale", {{"zero", false}}}}}};
  spec["layer"] = Json::array();
  if (look.band) {
    spec["layer"].push_back(makeBand());
  }
  Json points = makePoints(look);
  if (look.zoom) {
    points["params"] = makeZoom();
  }
  spec["layer"].push_back(makeLine("nominal", 1.2));
  spec["layer"].push_back(makeLine("updated", 1.6));
  spec["layer"].push_back(std::move(points));
  return {makeAlt("Measured, nominal and updated " + data.output + " over time", data), spec};
}

Panel makeResidualPanel(const ResponseData& data, const ResponseLook& look) {
  constexpr int kHeight = 70;
  const std::string title = "residual / sd";
  Json spec = makeSpec(data, kHeight);
  spec["transform"].push_back(
      {{"calculate", "(datum.measured - datum.updated) / datum.noise_stddev"}, {"as", "residual"}});
  const Json band{{"data", {{"values", {{{"low", -2}, {"high", 2}}}}}},
                  {"mark", {{"type", "rect"}, {"color", "var(--quiet)"}, {"opacity", 0.15}}},
                  {"encoding", {{"y", makeQuantitative("low", title)}, {"y2", {{"field", "high"}}}}}};
  Json points{
      {"mark",
       {{"type", "point"}, {"filled", true}, {"size", 10}, {"color", "var(--color-0)"}, {"clip", true}}},
      {"encoding",
       {{"x", makeQuantitative("time", "time [s]")}, {"y", makeQuantitative("residual", title)}}}};
  if (look.zoom) {
    points["params"] = makeZoom();
  }
  spec["layer"] = {band, std::move(points)};
  return {makeAlt("Residual of " + data.output + " in units of noise over time", data), spec};
}

}  // namespace twinmap
