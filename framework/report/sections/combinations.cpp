#include <fmt/core.h>

#include <cmath>

#include "framework/base/text/number_text.hpp"
#include "framework/experiment/check/known_names.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/report/html.hpp"
#include "framework/report/sections/sections.hpp"

namespace twinmap {
namespace {

constexpr const char* kCombinations = "combinations";
constexpr double kUndetermined = 0.5;  // of the box's own standard deviation

/// The sd that the mean information and the box leave along an eigenvector, over the one that the box alone
/// leaves: the variance of a uniform parameter is 1/12 of its squared width.
double calcRemaining(double eigenvalue) {
  return std::sqrt(kUniformInformation / (kUniformInformation + std::fmax(eigenvalue, 0.0)));
}

double getRemaining(const RunFolder& run, std::size_t row) {
  return calcRemaining(run.identifiability.getNumber(row, "eigenvalue"));
}

std::string toPercent(double fraction) {
  return toShortText(100.0 * fraction, 3) + " %";
}

/// "0.71 k_1 \u2212 0.7 k_2": what moves by more than a tenth.
std::string describeCombination(const RunFolder& run, std::size_t row) {
  constexpr double kMin = 0.1;
  std::string text;
  for (const std::string& name : collectNames(run.experiment.model.parameters)) {
    const double weight = run.identifiability.getNumber(row, name);
    if (std::abs(weight) >= kMin) {
      text += text.empty() ? (weight < 0.0 ? "\u2212" : "") : (weight < 0.0 ? " \u2212 " : " + ");
      text += toShortText(std::abs(weight), 2) + " " + name;
    }
  }
  return text;
}

/// In words: what stays undetermined, or that nothing does. Rows ascend in information.
std::string describeUndetermined(const RunFolder& run) {
  std::string text;
  for (std::size_t row = 0; row < run.identifiability.rows.size(); ++row) {
    const double remaining = getRemaining(run, row);
    if (remaining > kUndetermined) {
      text += "Undetermined: " + describeCombination(run, row) + ", of whose sd the data leave " +
              toPercent(remaining) + ". ";
    }
  }
  return text.empty() ? "No combination stays undetermined; the weakest is " + describeCombination(run, 0) +
                            ", of whose sd the data leave " + toPercent(getRemaining(run, 0)) + "."
                      : text;
}

DataTable makeCombinationTable(const RunFolder& run) {
  std::vector<std::string> combinations, parameters;
  std::vector<double> weights, remaining;
  for (std::size_t row = 0; row < run.identifiability.rows.size(); ++row) {
    for (const std::string& name : collectNames(run.experiment.model.parameters)) {
      combinations.push_back(fmt::format("{}: {} left", row + 1, toPercent(getRemaining(run, row))));
      parameters.push_back(name);
      weights.push_back(run.identifiability.getNumber(row, name));
      remaining.push_back(100.0 * getRemaining(run, row));
    }
  }
  DataTable table;
  table.add("combination", combinations);
  table.add("parameter", parameters);
  table.add("weight", weights);
  table.add("remaining_pct", remaining);
  return table;
}

/// The functions of parameters that the data determine where they do not determine these one by one.
std::string makeIdentified(const CsvTable& identified) {
  if (identified.empty()) {
    return "";
  }
  std::string yaml;
  for (std::size_t row = 0; row < identified.rows.size(); ++row) {
    const std::string& unit = identified.getText(row, "unit");
    if (!identified.getText(row, "name").empty()) {
      yaml += "  " + identified.getText(row, "name") + ": {value: " + identified.getText(row, "expression") +
              (unit.empty() ? "" : ", unit: " + unit) + "}\n";
    }
  }
  return makeElement("h3", "What is identified") + "\n" +
         makeHtmlTable("identified-table",
                       "Of these parameters the data determine these expressions; the residual is the sine "
                       "of the angle to what is determined, 0 where the expression is exact.",
                       identified,
                       {{"parameters", "parameters"},
                        {"undetermined", "undetermined"},
                        {"expression", "identified"},
                        {"unit", "unit"},
                        {"residual", "residual", 2}}) +
         (yaml.empty() ? ""
                       : makeParagraph("In the experiment file, to have them in all tables:") +
                             makeElement("pre", escapeHtml("derived:\n" + yaml)));
}

}  // namespace

void addCombinations(const RunFolder& run, Section& section, Page& page) {
  if (run.identifiability.empty()) {
    return;
  }
  page.tables[kCombinations] = makeCombinationTable(run);
  const std::string undetermined = describeUndetermined(run);
  addFigure({kCombinations,
             "Which combinations the data determine",
             "Each row is a combination of parameters that the data determine on its own (an eigenvector of "
             "the mean Fisher information), the weakest first, with the part of the sd allowed by the bounds "
             "that is left at best: near 100 % the data say nothing about it.",
             kCombinations,
             {{"combinations",
               {{"undetermined", undetermined}},
               {{"height", calcHeatHeight(run.identifiability.rows.size())}}}},
             {},
             1},
            section);
  section.html += makeParagraph(undetermined) + makeIdentified(run.identified);
}

}  // namespace twinmap
