#include <algorithm>
#include <cmath>

#include "framework/report/html.hpp"
#include "framework/report/sections/sections.hpp"

namespace twinmap {
namespace {

constexpr const char* kMethods = "methods";

std::string makeMethodTable(const CsvTable& methods) {
  return makeHtmlTable(
      "methods-table",
      "The figures of a method are those of the measurements that it accepted; the table above "
      "has what is answered by default.",
      methods,
      showFigures({{"method", "method"}, {"parameter", "parameter"}},
                  {{"accepted", "share accepted"}, {"median_simulations", "simulations, median"}}));
}

DataTable makeMethodData(const CsvTable& methods) {
  DataTable table;
  table.add("method", methods.listTexts("method"));
  table.add("parameter", methods.listTexts("parameter"));
  table.add("ratio", methods.listNumbers("ratio_to_limit"));
  table.add("coverage95", methods.listNumbers("coverage95"));
  return table;
}

bool hasRatio(const CsvTable& methods) {
  const std::vector<double> ratios = methods.listNumbers("ratio_to_limit");
  return std::any_of(ratios.begin(), ratios.end(), [](double ratio) { return std::isfinite(ratio); });
}

}  // namespace

void addMethods(const RunFolder& run, Page& page) {
  const CsvTable& methods = run.methods;
  if (methods.empty()) {
    return;
  }
  constexpr int kRowHeight = 28, kFrame = 20;
  Section section{"methods", "From the map to the answer", "", {}};
  section.html = makeMethodTable(methods);
  if (hasRatio(methods)) {
    const std::vector<std::string> names = methods.listDistinct("method");
    const std::size_t parameters = methods.rows.size() / names.size();
    page.tables[kMethods] = makeMethodData(methods);
    addFigure(
        {"methods",
         "How near the limit each method comes",
         "On the dashed line a method is as good as the noise of the data allows any.",
         kMethods,
         {{"methods", {}, {{"height", calcHeight(parameters, kRowHeight, kFrame)}, {"methods", names}}}},
         {},
         1},
        section);
  }
  page.sections.push_back(std::move(section));
}

}  // namespace twinmap
