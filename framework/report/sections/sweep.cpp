#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "framework/base/text/csv.hpp"
#include "framework/base/text/number_text.hpp"
#include "framework/report/html.hpp"
#include "framework/report/sections/sections.hpp"
#include "framework/report/sections/sweep_figures.hpp"
#include "framework/report/sections/verdict.hpp"

namespace twinmap {
namespace {

/// The distinct finite values of a member, ascending.
std::vector<double> collectValues(const std::vector<SweepGroup>& groups, double SweepGroup::*member) {
  std::set<double> values;
  for (const SweepGroup& group : groups) {
    if (std::isfinite(group.*member)) {
      values.insert(group.*member);
    }
  }
  return {values.begin(), values.end()};
}

/// A row for each group.
CsvTable tabulate(const std::vector<SweepGroup>& groups) {
  CsvTable table{{"parameter", "variant", "size", "noise", "seeds", "sd_pct", "lowest", "highest",
                  "limit_pct", "coverage95"},
                 {}};
  for (const SweepGroup& group : groups) {
    table.rows.push_back({group.parameter, group.variant});
    for (const double value : {group.size, group.noise, static_cast<double>(group.seeds), group.mean,
                               group.lowest, group.highest, group.limit, group.coverage}) {
      table.rows.back().push_back(toText(value));
    }
  }
  return table;
}

DataTable makeGroupData(const CsvTable& groups) {
  DataTable table;
  table.add("variant", groups.listTexts("variant"));
  table.add("parameter", groups.listTexts("parameter"));
  for (const char* column :
       {"size", "noise", "seeds", "sd_pct", "lowest", "highest", "limit_pct", "coverage95"}) {
    table.add(column, groups.listNumbers(column));
  }
  return table;
}

/// Without the columns that say nothing: of variants where there is one, of limits where none was computed.
std::string makeGroupTable(const CsvTable& groups) {
  const auto is_empty = [&](const char* column) {
    const std::vector<std::string> texts = groups.listTexts(column);
    return std::all_of(texts.begin(), texts.end(),
                       [](const std::string& text) { return text.empty() || text == "nan"; });
  };
  std::vector<ShownColumn> columns{{"parameter", "parameter"}};
  if (!is_empty("variant")) {
    columns.push_back({"variant", "variant"});
  }
  columns.insert(columns.end(), {{"size", "training samples", 6},
                                 {"noise", "noise scale", 6},
                                 {"seeds", "seeds"},
                                 {"sd_pct", "sd %"},
                                 {"lowest", "lowest %"},
                                 {"highest", "highest %"}});
  if (!is_empty("limit_pct")) {
    columns.push_back({"limit_pct", "limit %"});
  }
  columns.push_back({"coverage95", "cov. 95 %", 3});
  return makeHtmlTable("sweep-table",
                       "Means over the seeds; press a heading to sort. Every case is in sweep.csv.", groups,
                       columns);
}

std::size_t countCases(const CsvTable& sweep) {
  std::set<std::string> cases;
  for (std::size_t row = 0; row < sweep.rows.size(); ++row) {
    std::string name = sweep.getText(row, "case");
    for (const std::string& key : findVariedKeys(sweep)) {
      name += "|" + sweep.getText(row, key);
    }
    cases.insert(name);
  }
  return cases.size();
}

}  // namespace

void addSweepVerdict(const SweepFolder& sweep, const RunFolder* shown, const std::vector<GateResult>& gates,
                     Page& page) {
  const std::size_t cases = countCases(sweep.table);
  Section section{"verdict", "Verdict", "", {}};
  if (shown != nullptr && !shown->experiment.description.empty()) {
    section.html += makeParagraph(shown->experiment.description);
  }
  std::string varied;
  for (const std::string& key : findVariedKeys(sweep.table)) {
    varied += (varied.empty() ? "" : ", ") + key;
  }
  section.html += makeParagraph(fmt::format("A sweep of {} cases over {}.", cases, varied), "class=\"lead\"");
  section.html += makeGateList(gates);
  section.html += makeParagraph(
      "The cases are summarised: one value per case and parameter, their means over the seeds in the table." +
      (shown == nullptr
           ? std::string()
           : " What concerns single test samples is shown for the case " + shown->label +
                 ", the one with the smallest errors; 'twinmap report' on the folder of another case "
                 "shows that one."));
  page.sections.push_back(std::move(section));
}

void addSweep(const SweepFolder& sweep, Page& page) {
  SweepAxes axes;
  axes.groups = groupCases(sweep.table);
  if (axes.groups.empty()) {
    return;
  }
  const CsvTable groups = tabulate(axes.groups);
  axes.parameters = groups.listDistinct("parameter");
  axes.variants = groups.listDistinct("variant");
  axes.sizes = collectValues(axes.groups, &SweepGroup::size);
  axes.noises = collectValues(axes.groups, &SweepGroup::noise);
  axes.has_limits = !collectValues(axes.groups, &SweepGroup::limit).empty();
  page.tables[kSweepTable] = makeGroupData(groups);
  page.texts.emplace_back("sweep-csv", makeCsv(sweep.table));
  Section section{"sweep", "Sweep", "", {}};
  if (axes.sizes.size() > 1) {
    addFigure(makeCurveFigure(axes, true), section);
  }
  if (axes.noises.size() > 1) {
    addFigure(makeCurveFigure(axes, false), section);
  }
  if (axes.sizes.size() > 1 && axes.noises.size() > 1) {
    addFigure(makeHeatMapFigure(axes), section);
  }
  if (section.figures.empty()) {
    addFigure(makeVariantFigure(axes), section);
  }
  section.html += makeGroupTable(groups) + makeCopyButtons({{"sweep-csv", "CSV of every case"}});
  page.sections.push_back(std::move(section));
}

}  // namespace twinmap
