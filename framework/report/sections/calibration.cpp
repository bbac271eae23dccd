#include <algorithm>
#include <boost/math/distributions/binomial.hpp>

#include "framework/report/sections/calibration_tables.hpp"
#include "framework/report/sections/samples_table.hpp"
#include "framework/report/sections/sections.hpp"
#include "framework/report/vega.hpp"
#include "framework/spec/check/check_experiment.hpp"

namespace twinmap {
namespace {

constexpr int kBins = 10;  // of the PIT histogram

Json makeDiagonal(double from, double to) {
  return {{"data", {{"values", {{{"v", from}}, {{"v", to}}}}}},
          {"mark", {{"type", "line"}, {"color", "var(--quiet)"}, {"strokeDash", {4, 3}}, {"strokeWidth", 1}}},
          {"encoding",
           {{"x", {{"field", "v"}, {"type", "quantitative"}}},
            {"y", {{"field", "v"}, {"type", "quantitative"}}}}}};
}

Json makeBand(const std::string& x, const std::string& x_title, const std::string& y_title) {
  return {{"mark", {{"type", "area"}, {"color", "var(--quiet)"}, {"opacity", 0.15}}},
          {"encoding",
           {{"x", makeQuantitative(x, x_title)},
            {"y", makeQuantitative("lower", y_title)},
            {"y2", {{"field", "upper"}}}}}};
}

Json makeHighlighted(Json encoding, const Json& color) {
  encoding["size"] = {{"value", 55}};
  encoding["color"] = color;
  return {{"transform", {{{"filter", "selected && selected[datum.sample]"}}}},
          {"mark", {{"type", "point"}, {"filled", true}}},
          {"encoding", encoding}};
}

Figure makeReliability(const std::vector<std::string>& names, int n, Page& page) {
  const std::string x_title = "level of the central interval", y_title = "fraction of true values within";
  page.tables["reliability-band"] = makeReliabilityBand(n);
  const Json x = makeQuantitative("level", x_title, makeDomain(0, 1));
  const Json y = makeQuantitative("observed", y_title, makeDomain(0, 1));
  Json color = makeNominal("parameter", "", makeColorScale(names));
  color["legend"] = {{"symbolType", "stroke"}};
  Json spec = makePanelSpec("reliability", 260);
  Json band = makeBand("level", x_title, y_title);
  band["data"] = {{"name", "reliability-band"}};
  spec["layer"] = {band,
                   makeDiagonal(0, 1),
                   {{"mark", {{"type", "line"}, {"strokeWidth", 1.6}, {"interpolate", "step-after"}}},
                    {"encoding",
                     {{"x", x},
                      {"y", y},
                      {"color", color},
                      {"strokeDash", makeNominal("parameter", "", makeDashScale(names))}}}},
                   makeHighlighted({{"x", x}, {"y", y}}, color)};
  return {"reliability",
          "Reliability",
          "A line above the diagonal means intervals wider than needed, one below means "
          "overconfidence; within the grey band (95 % for each level, " +
              std::to_string(n) + " samples) the difference may be chance.",
          "reliability",
          {{"Observed against nominal coverage of the inferred intervals, a line per parameter", spec}},
          {},
          1};
}

/// Counts of the PIT in equal bins, with the band of a uniform histogram.
Panel makePitPanel(const std::string& name, std::size_t p, int n) {
  const boost::math::binomial_distribution<> binomial(n, 1.0 / kBins);
  const double low = boost::math::quantile(binomial, 0.5 * (1.0 - kConfidence));
  const double high = boost::math::quantile(binomial, 0.5 * (1.0 + kConfidence));
  Json spec = makePanelSpec("samples", 90);
  spec["title"] = name;
  const Json x = makeQuantitative(
      getPitColumn(name), "PIT",
      {{"bin", {{"extent", {0, 1}}, {"step", 1.0 / kBins}}}, {"scale", {{"domain", {0, 1}}}}});
  const Json y{{"aggregate", "count"}, {"type", "quantitative"}, {"title", "test samples"}};
  const Json highlighted{
      {"aggregate", "sum"}, {"field", "highlighted"}, {"type", "quantitative"}, {"title", "test samples"}};
  spec["layer"] = {
      {{"mark", {{"type", "bar"}, {"color", getColor(p)}, {"opacity", 0.55}}},
       {"encoding", {{"x", x}, {"y", y}}}},
      {{"transform", {{{"calculate", "selected && selected[datum.sample] ? 1 : 0"}, {"as", "highlighted"}}}},
       {"mark", {{"type", "bar"}, {"color", getColor(p)}}},
       {"encoding", {{"x", x}, {"y", highlighted}}}},
      {{"data", {{"values", {{{"low", low}, {"high", high}}}}}},
       {"mark", {{"type", "rect"}, {"color", "var(--quiet)"}, {"opacity", 0.22}}},
       {"encoding", {{"y", makeQuantitative("low", "test samples")}, {"y2", {{"field", "high"}}}}}}};
  return {"Histogram of the probability integral transform of " + name, spec};
}

Figure makePit(const std::vector<std::string>& names, int n) {
  Figure figure{
      "pit",
      "PIT histogram",
      "The probability that the map gave to values below the true one: flat within the grey band where "
      "calibrated, a U where the sd is too small, a hump where it is too large.",
      "samples",
      {},
      {},
      names.size() >= 4 ? 4 : 0};
  for (std::size_t p = 0; p < names.size(); ++p) {
    figure.panels.push_back(makePitPanel(names[p], p, n));
  }
  return figure;
}

Panel makeQuantilePanel(const std::string& name, std::size_t p) {
  const std::string x_title = "normal quantile", y_title = "error / sd";
  const Json x = makeQuantitative("quantile", x_title), y = makeQuantitative("z", y_title);
  Json spec = makePanelSpec("z-scores", 130);
  spec["title"] = name;
  spec["transform"] = {{{"filter", {{"field", "parameter"}, {"equal", name}}}}};
  Json points{
      {"mark", {{"type", "point"}, {"filled", true}, {"color", getColor(p)}}},
      {"encoding",
       {{"x", x},
        {"y", y},
        {"opacity", {{"condition", {{"test", kIsSelected}, {"value", 0.85}}}, {"value", 0.15}}},
        {"size",
         {{"condition", {{"test", "selected && selected[datum.sample]"}, {"value", 60}}}, {"value", 10}}},
        {"tooltip",
         {makeNominal("sample", "sample"), makeQuantitative("z", y_title, {{"format", ".3~g"}})}}}}};
  spec["layer"] = {makeBand("quantile", x_title, y_title), makeDiagonal(-3, 3), points};
  return {"z-scores of " + name + " against normal quantiles", spec};
}

Figure makeQuantiles(const std::vector<std::string>& names) {
  Figure figure{"z-scores",
                "z-scores against the normal distribution",
                "Points on the dashed line and within the grey band (95 % for each point) are as a normal "
                "distribution with the inferred sd says; steeper means overconfident, an offset means bias.",
                "z-scores",
                {},
                {},
                names.size() >= 4 ? 4 : 0};
  for (std::size_t p = 0; p < names.size(); ++p) {
    figure.panels.push_back(makeQuantilePanel(names[p], p));
  }
  return figure;
}

}  // namespace

void addCalibration(const RunFolder& run, Page& page) {
  if (run.predictions.empty()) {
    return;
  }
  const std::vector<std::string> names = collectNames(run.experiment.model.parameters);
  page.tables["reliability"] = makeReliabilityTable(run);
  page.tables["z-scores"] = makeQuantileTable(run);
  const int n = std::max(1, static_cast<int>(page.tables["z-scores"].countRows() / names.size()));
  Section section{"calibration", "Calibration", "", {}};
  addFigure(makeReliability(names, n, page), section);
  addFigure(makePit(names, n), section);
  addFigure(makeQuantiles(names), section);
  addPosterior(run, section, page);
  page.sections.push_back(std::move(section));
}

}  // namespace twinmap
