#include <algorithm>
#include <cmath>

#include "framework/report/html.hpp"
#include "framework/report/sections/sections.hpp"

namespace twinmap {
namespace {

/// Methods, or maps, beside each other on the same samples.
struct Methods {
  const CsvTable& file;
  std::string key;   ///< the column that names them
  std::string name;  ///< of the section, of its figure and of that's data
  std::string title;
  std::vector<ShownColumn> beyond;  ///< shown behind the figures
};

bool hasRatio(const CsvTable& file) {
  const std::vector<double> ratios = file.listNumbers("ratio_to_limit");
  return std::any_of(ratios.begin(), ratios.end(), [](double ratio) { return std::isfinite(ratio); });
}

void addLimitFigure(const Methods& methods, Page& page, Section& section) {
  constexpr int kRowHeight = 28, kFrame = 20;
  const std::vector<std::string> names = methods.file.listDistinct(methods.key);
  const double height = calcHeight(methods.file.rows.size() / names.size(), kRowHeight, kFrame);
  DataTable& table = page.tables[methods.name];
  table.add("method", methods.file.listTexts(methods.key));
  table.add("parameter", methods.file.listTexts("parameter"));
  table.add("ratio", methods.file.listNumbers("ratio_to_limit"));
  table.add("coverage95", methods.file.listNumbers("coverage95"));
  addFigure({methods.name,
             "How near the limit each " + methods.key + " comes",
             "On the dashed line a " + methods.key + " is as good as the noise of the data allows any.",
             methods.name,
             {{"methods", {}, {{"height", height}, {"methods", names}}}},
             {},
             1},
            section);
}

/// Their figures in a table, and how near the limit they come.
void addSection(const Methods& methods, const std::string& caption, Page& page) {
  if (methods.file.empty()) {
    return;
  }
  Section section{methods.name, methods.title, "", {}};
  section.html =
      makeHtmlTable(methods.name + "-table", caption, methods.file,
                    showFigures({{methods.key, methods.key}, {"parameter", "parameter"}}, methods.beyond));
  if (hasRatio(methods.file)) {
    addLimitFigure(methods, page, section);
  }
  page.sections.push_back(std::move(section));
}

}  // namespace

void addMethods(const RunFolder& run, Page& page) {
  addSection({run.methods,
              "method",
              "methods",
              "Before and after refinement",
              {{"accepted", "share accepted"}, {"median_simulations", "simulations, median"}}},
             "The figures of a method are those of the measurements that it accepted; the table above has "
             "what is reported by default.",
             page);
}

void addComparedMaps(const RunFolder& run, Page& page) {
  addSection({run.compared_maps,
              "map",
              "compared-maps",
              "Which estimator",
              {{"joint_coverage95", "joint cov. 95 %"},
               {"joint_nlpd", "joint NLPD"},
               {"training_seconds", "training, s"},
               {"online_us", "a measurement, us"},
               {"bytes", "bytes"}}},
             "Each estimator alone, without refinement, on the same samples. Training includes the "
             "goodness-of-fit test; the smallest joint NLPD is the best density of all parameters.",
             page);
}

}  // namespace twinmap
