#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "framework/base/text/csv.hpp"
#include "framework/base/text/number_text.hpp"
#include "framework/report/figure.hpp"
#include "framework/report/html.hpp"
#include "framework/report/sections/sections.hpp"
#include "framework/report/sections/sweep_groups.hpp"
#include "framework/report/sections/verdict.hpp"

namespace twinmap {
namespace {

/// The table of groups that the figures of a sweep draw: variant, parameter, size, noise, seeds, sd_pct,
/// lowest, highest, limit_pct, coverage95.
inline constexpr const char* kSweepTable = "sweep";

/// What the sweep varied, and how its figures tell lines apart.
struct SweepAxes {
  std::vector<SweepGroup> groups;
  std::vector<std::string> parameters, variants;
  std::vector<double> sizes, noises;
  bool has_limits = false;
};

Choice makeChoice(const std::string& name, const std::string& label, const std::vector<std::string>& values) {
  Choice choice{name, label, {}, 0};
  for (const std::string& value : values) {
    choice.options.push_back({value, value.empty() ? "as in the file" : value, {}});
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

/// What a figure of curves has on its horizontal axis, and what else the sweep varied.
struct CurveAxes {
  std::string x, x_title;
  std::string other, other_title;  ///< what is not on the axis
  std::vector<double> others;      ///< its values; none if the sweep did not vary it
};

CurveAxes makeCurveAxes(const SweepAxes& axes, bool over_size) {
  return over_size ? CurveAxes{"size", "training samples", "noise", "noise scale", axes.noises}
                   : CurveAxes{"noise", "noise scale", "size", "training samples", axes.sizes};
}

/// Slots of the skeleton that curves by variant, or by the other axis, do not have.
std::set<std::string> findMissingSlots(const SweepAxes& axes, const CurveAxes& curves) {
  const bool by_variant = axes.variants.size() > 1;
  std::set<std::string> missing{by_variant ? "grouped" : "chosen"};
  if (curves.others.empty()) {
    missing.insert(by_variant ? "chosen" : "colors");
  }
  if (!axes.has_limits) {
    missing.insert("limit");
  }
  return missing;
}

/// The curves of one parameter: a line per variant, or per value of `other` if there is one variant only.
Panel makeCurves(const SweepAxes& axes, const CurveAxes& curves, const std::string& parameter) {
  const bool by_variant = axes.variants.size() > 1;
  const SlotValue none = nullptr;
  Panel panel{"error-curves",
              {{"parameter", parameter},
               {"x", curves.x},
               {"x_title", curves.x_title},
               {"grouping", curves.other},
               {"series", by_variant ? "variant" : curves.other}},
              {{"series", by_variant ? axes.variants : toTexts(curves.others)},
               {"series_title", by_variant ? none : curves.other_title}},
              findMissingSlots(axes, curves)};
  if (!by_variant && curves.others.empty()) {  // a single line
    panel.values["legends"] = none;
  }
  return panel;
}

Figure makeSweepFigure(const std::string& name, const std::string& title, const std::string& help) {
  constexpr int kColumns = 2;
  return {name, title, help, kSweepTable, {}, {}, kColumns};
}

/// sd over the training size, or over the noise; logarithmic.
Figure makeCurveFigure(const SweepAxes& axes, bool over_size) {
  const CurveAxes curves = makeCurveAxes(axes, over_size);
  Figure figure = makeSweepFigure(
      "error-over-" + curves.x, "Error against " + curves.x_title,
      std::string(
          "Each line is the mean over the seeds, its band reaches from the lowest to the highest seed") +
          (axes.has_limits ? "; dotted: the information limit, below which no estimator can come." : "."));
  for (const std::string& parameter : axes.parameters) {
    figure.panels.push_back(makeCurves(axes, curves, parameter));
  }
  if (axes.variants.size() > 1 && !curves.others.empty()) {
    figure.choices.push_back(makeChoice("other", curves.other_title, toTexts(curves.others)));
  }
  return figure;
}

Figure makeHeatMapFigure(const SweepAxes& axes) {
  constexpr int kRowHeight = 30, kFrame = 20;
  Figure figure = makeSweepFigure("size-noise", "Size against noise",
                                  "The mean sd of the relative error in %: along a row the gain from more "
                                  "simulations, along a column the gain from better sensors.");
  const double height = calcHeight(axes.noises.size(), kRowHeight, kFrame);
  for (const std::string& parameter : axes.parameters) {
    figure.panels.push_back({"size-noise", {{"parameter", parameter}}, {{"height", height}}});
  }
  figure.choices = {makeChoice("variant", "inverse map", axes.variants)};
  return figure;
}

/// For sweeps over neither size nor noise: one row per variant.
Figure makeVariantFigure(const SweepAxes& axes) {
  constexpr int kRowHeight = 26, kFrame = 20;
  Figure figure = makeSweepFigure("variants", "Error of each variant",
                                  "The mean over the seeds, its bar from the lowest to the highest seed; the "
                                  "tick is the information limit.");
  const double height = calcHeight(axes.variants.size(), kRowHeight, kFrame);
  for (const std::string& parameter : axes.parameters) {
    figure.panels.push_back({"variants", {{"parameter", parameter}}, {{"height", height}}});
    if (!axes.has_limits) {
      figure.panels.back().without = {"limit"};
    }
  }
  return figure;
}

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
      (shown == nullptr ? std::string()
                        : " What concerns single test samples is shown for the case " + shown->label +
                              ", the one with the smallest errors; 'twinmap report' on the folder of another "
                              "case shows that one."));
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
