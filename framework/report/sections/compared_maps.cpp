#include "framework/report/html.hpp"
#include "framework/report/sections/metric_columns.hpp"
#include "framework/report/sections/sections.hpp"

namespace twinmap {
namespace {

constexpr const char* kComparedMaps = "compared-maps";

const std::vector<MetricColumn>& getMapColumns() {
  static const std::vector<MetricColumn> columns{{"sd_pct", "sd %"},
                                                 {"ratio_to_limit", "sd / limit"},
                                                 {"nats_above_limit", "nats above limit"},
                                                 {"coverage50", "coverage 50 %"},
                                                 {"coverage95", "coverage 95 %"},
                                                 {"nlpd", "nlpd"},
                                                 {"joint_coverage95", "joint coverage 95 %"},
                                                 {"joint_nlpd", "joint nlpd"},
                                                 {"training_seconds", "training, s"},
                                                 {"online_us", "a measurement, us"},
                                                 {"bytes", "bytes"}};
  return columns;
}

std::string makeMapTable(const CsvTable& maps) {
  std::vector<std::string> headings{"map", "parameter"};
  for (const MetricColumn& column : getMapColumns()) {
    headings.push_back(column.heading);
  }
  std::vector<std::vector<HtmlCell>> rows;
  for (std::size_t row = 0; row < maps.rows.size(); ++row) {
    rows.push_back({makeTextCell(maps.getText(row, "map")), makeTextCell(maps.getText(row, "parameter"))});
    for (const MetricColumn& column : getMapColumns()) {
      rows.back().push_back(makeNumberCell(maps.getText(row, column.name), kMetricDigits));
    }
  }
  return makeHtmlTable(
      "compared-maps-table",
      "Each map alone, without refinement, on the same samples. Training includes what its "
      "answers are judged by; the smallest joint nlpd is the best density of all parameters.",
      headings, rows);
}

DataTable makeMapData(const CsvTable& maps) {
  std::vector<std::string> names, parameters;
  std::vector<double> ratios, coverages;
  for (std::size_t row = 0; row < maps.rows.size(); ++row) {
    names.push_back(maps.getText(row, "map"));
    parameters.push_back(maps.getText(row, "parameter"));
    ratios.push_back(maps.getNumber(row, "ratio_to_limit"));
    coverages.push_back(maps.getNumber(row, "coverage95"));
  }
  DataTable table;
  table.add("method", std::move(names));
  table.add("parameter", std::move(parameters));
  table.add("ratio", std::move(ratios));
  table.add("coverage95", std::move(coverages));
  return table;
}

std::vector<std::string> listMaps(const CsvTable& maps) {
  std::vector<std::string> names;
  for (std::size_t row = 0; row < maps.rows.size(); ++row) {
    if (names.empty() || names.back() != maps.getText(row, "map")) {
      names.push_back(maps.getText(row, "map"));
    }
  }
  return names;
}

}  // namespace

void addComparedMaps(const RunFolder& run, Page& page) {
  const CsvTable& maps = run.compared_maps;
  if (maps.empty()) {
    return;
  }
  constexpr int kRowHeight = 28, kFrame = 20;
  Section section{kComparedMaps, "Which map", "", {}};
  section.html = makeMapTable(maps);
  const std::vector<std::string> names = listMaps(maps);
  if (!maps.getText(0, "ratio_to_limit").empty()) {
    page.tables[kComparedMaps] = makeMapData(maps);
    const double height = calcHeight(maps.rows.size() / names.size(), kRowHeight, kFrame);
    addFigure({kComparedMaps,
               "How near the limit each map comes",
               "On the dashed line a map is as good as the noise of the data allows any.",
               kComparedMaps,
               {{"methods", {}, {{"height", height}, {"methods", names}}}},
               {},
               1},
              section);
  }
  page.sections.push_back(std::move(section));
}

}  // namespace twinmap
