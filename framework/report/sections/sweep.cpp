#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "framework/base/text/csv.hpp"
#include "framework/base/text/number_text.hpp"
#include "framework/report/html.hpp"
#include "framework/report/sections/sections.hpp"
#include "framework/report/sections/sweep_figures.hpp"
#include "framework/report/verdict.hpp"

namespace twinmap {
namespace {

std::vector<std::string> collectGroupParameters(const std::vector<SweepGroup>& groups) {
  std::vector<std::string> names;
  for (const SweepGroup& group : groups) {
    if (std::find(names.begin(), names.end(), group.parameter) == names.end()) {
      names.push_back(group.parameter);
    }
  }
  return names;
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

std::vector<std::string> collectVariants(const std::vector<SweepGroup>& groups) {
  std::vector<std::string> variants;
  for (const SweepGroup& group : groups) {
    if (std::find(variants.begin(), variants.end(), group.variant) == variants.end()) {
      variants.push_back(group.variant);
    }
  }
  return variants;
}

DataTable makeGroupTable(const std::vector<SweepGroup>& groups) {
  std::vector<std::string> variant, parameter;
  std::vector<double> size, noise, seeds, mean, lowest, highest, limit, coverage;
  for (const SweepGroup& group : groups) {
    variant.push_back(group.variant);
    parameter.push_back(group.parameter);
    size.push_back(group.size);
    noise.push_back(group.noise);
    seeds.push_back(group.seeds);
    mean.push_back(group.mean);
    lowest.push_back(group.lowest);
    highest.push_back(group.highest);
    limit.push_back(group.limit);
    coverage.push_back(group.coverage);
  }
  DataTable table;
  table.add("variant", variant);
  table.add("parameter", parameter);
  table.add("size", size);
  table.add("noise", noise);
  table.add("seeds", seeds);
  table.add("sd_pct", mean);
  table.add("lowest", lowest);
  table.add("highest", highest);
  table.add("limit_pct", limit);
  table.add("coverage95", coverage);
  return table;
}

std::string makeGroupTable(const SweepAxes& axes) {
  std::vector<std::vector<HtmlCell>> rows;
  for (const SweepGroup& group : axes.groups) {
    rows.push_back({makeTextCell(group.parameter), makeTextCell(group.variant),
                    makeNumberCell(toText(group.size), 6), makeNumberCell(toText(group.noise), 6),
                    makeNumberCell(std::to_string(group.seeds)), makeNumberCell(toText(group.mean)),
                    makeNumberCell(toText(group.lowest)), makeNumberCell(toText(group.highest)),
                    makeNumberCell(toText(group.limit)), makeNumberCell(toText(group.coverage), 3)});
  }
  return makeHtmlTable("sweep-table",
                       "Means over the seeds; press a heading to sort. Every case is in sweep.csv.",
                       {"parameter", "variant", "training samples", "noise scale", "seeds", "sd %",
                        "lowest %", "highest %", "limit %", "coverage 95 %"},
                       rows);
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
  axes.parameters = collectGroupParameters(axes.groups);
  axes.variants = collectVariants(axes.groups);
  axes.sizes = collectValues(axes.groups, &SweepGroup::size);
  axes.noises = collectValues(axes.groups, &SweepGroup::noise);
  axes.has_limits = !collectValues(axes.groups, &SweepGroup::limit).empty();
  page.tables[kSweepTable] = makeGroupTable(axes.groups);
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
  section.html += makeGroupTable(axes) + makeCopyButtons({{"sweep-csv", "CSV of every case"}});
  page.sections.push_back(std::move(section));
}

}  // namespace twinmap
