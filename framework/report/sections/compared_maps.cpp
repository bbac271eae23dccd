#include "framework/report/html.hpp"
#include "framework/report/sections/sections.hpp"

namespace twinmap {
namespace {

constexpr const char* kComparedMaps = "compared-maps";

std::string makeMapTable(const CsvTable& maps) {
  return makeHtmlTable(
      "compared-maps-table",
      "Each map alone, without refinement, on the same samples. Training includes what its "
      "answers are judged by; the smallest joint nlpd is the best density of all parameters.",
      maps,
      showFigures({{"map", "map"}, {"parameter", "parameter"}}, {{"joint_coverage95", "joint cov. 95 %"},
                                                                 {"joint_nlpd", "joint NLPD"},
                                                                 {"training_seconds", "training, s"},
                                                                 {"online_us", "a measurement, us"},
                                                                 {"bytes", "bytes"}}));
}

DataTable makeMapData(const CsvTable& maps) {
  DataTable table;
  table.add("method", maps.listTexts("map"));
  table.add("parameter", maps.listTexts("parameter"));
  table.add("ratio", maps.listNumbers("ratio_to_limit"));
  table.add("coverage95", maps.listNumbers("coverage95"));
  return table;
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
  const std::vector<std::string> names = maps.listDistinct("map");
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
