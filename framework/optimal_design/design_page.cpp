#include "framework/optimal_design/design_page.hpp"

#include <fmt/core.h>

#include <cmath>
#include <limits>

#include "framework/analysis/identifiability.hpp"
#include "framework/base/text/number_text.hpp"
#include "framework/data/sensitivity/fisher_information.hpp"
#include "framework/report/figure.hpp"
#include "framework/report/html.hpp"
#include "framework/report/sections/verdict.hpp"
#include "framework/simulation/excitation/calc_input_signals.hpp"

namespace twinmap::experiment_design {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Cells = std::vector<HtmlCell>;

HtmlCell makeCell(double value) {
  return makeNumberCell(std::isfinite(value) ? toText(value) : "");
}

/// Mean and worst limit sd over the bounds of two excitations, and their ratios.
Cells makeLimitRow(const ParameterSpec& parameter, const VectorXd& before, const VectorXd& after) {
  return {makeTextCell(parameter.name.text),
          makeTextCell(parameter.unit),
          makeCell(before.mean()),
          makeCell(after.mean()),
          makeCell(after.mean() / before.mean()),
          makeCell(before.maxCoeff()),
          makeCell(after.maxCoeff()),
          makeCell(after.maxCoeff() / before.maxCoeff())};
}

std::string makeLimitTable(const std::string& id, const std::string& caption, const ExcitationDesign& design,
                           const std::pair<std::string, const JudgedExcitation*>& a,
                           const std::pair<std::string, const JudgedExcitation*>& b) {
  std::vector<Cells> rows;
  for (std::size_t p = 0; p < design.parameters.size(); ++p) {
    const auto row = static_cast<Index>(p);
    rows.push_back(
        makeLimitRow(design.parameters[p], a.second->limit.stddev.row(row), b.second->limit.stddev.row(row)));
  }
  return makeHtmlTable(id, caption,
                       {"parameter", "unit", "mean " + a.first, "mean " + b.first, "ratio",
                        "worst " + a.first, "worst " + b.first, "ratio"},
                       rows);
}

std::string makeMeasureTable(const ExcitationDesign& design) {
  std::vector<Cells> rows;
  for (std::size_t i = 0; i < design.limits.size(); ++i) {
    const Limit& limit = design.limits[i];
    const auto reached = [&](const JudgedExcitation& judged) {
      return judged.largest.size() > static_cast<Index>(i) ? judged.largest[static_cast<Index>(i)]
                                                           : std::numeric_limits<double>::quiet_NaN();
    };
    const double after = reached(design.after);
    rows.push_back({makeTextCell(describe(limit)), makeTextCell(limit.unit), makeCell(limit.most),
                    makeCell(reached(design.before)), makeCell(after),
                    makeCell(100.0 * (1.0 - after / limit.most)), makeCell(reached(design.nominal))});
  }
  return makeHtmlTable("limits-table",
                       fmt::format("Largest values at {} points within the bounds, random ones and corners.",
                                   design.check_points),
                       {"measure", "unit", "limit", "before", "after", "margin %", "designed for the centre"},
                       rows);
}

std::string makeSignalTable(const ExcitationEvaluator& evaluator, const ExcitationDesign& design) {
  std::vector<Cells> rows;
  const std::vector<SignalSpec>& signals = evaluator.getExperiment().model.excitation;
  for (std::size_t s = 0; s < signals.size(); ++s) {
    for (const auto& [name, judged] : {std::pair("before", &design.before), {"after", &design.after}}) {
      const SignalMeasure& measure = judged->signals[s];
      rows.push_back({makeTextCell(signals[s].name.text), makeTextCell(name), makeCell(measure.max_abs),
                      makeCell(measure.rms), makeCell(measure.crest_factor()), makeCell(measure.max_rate)});
    }
  }
  return makeHtmlTable("signals-table", "Signals at the centre of the bounds.",
                       {"signal", "", "largest", "rms", "crest factor", "largest rate"}, rows);
}

std::vector<double> listColumn(const MatrixXd& values, Index column) {
  return {values.col(column).begin(), values.col(column).end()};
}

void addSignalFigures(const ExcitationEvaluator& evaluator, const ExcitationDesign& design, Page& page,
                      Section& section) {
  constexpr Index kTimes = 2001;
  const ModelSpec before = evaluator.makeExperiment(design.before.values).model;
  const ModelSpec after = evaluator.makeExperiment(design.after.values).model;
  const VectorXd times = VectorXd::LinSpaced(kTimes, 0.0, before.simulation.duration);
  const InputSignals old_signals = calcInputSignals(before, times);
  const InputSignals new_signals = calcInputSignals(after, times);
  for (std::size_t s = 0; s < old_signals.names.size(); ++s) {
    const std::string table = "signal-" + std::to_string(s);
    DataTable& data = page.tables[table];
    data.add("time", std::vector<double>(times.begin(), times.end()));
    data.add("before", listColumn(old_signals.values, static_cast<Index>(s)));
    data.add("after", listColumn(new_signals.values, static_cast<Index>(s)));
    const Texts texts{{"table", table}, {"label", makeLabel(old_signals.names[s], old_signals.units[s])}};
    addFigure({table,
               "The signal " + old_signals.names[s],
               "Before and after the design.",
               table,
               {{"design-signal", texts}},
               {},
               1},
              section);
  }
}

DataTable makePath(const ExcitationDesign& design) {
  VectorXd most(static_cast<Index>(design.limits.size()));
  for (Index i = 0; i < most.size(); ++i) {
    most[i] = design.limits[static_cast<std::size_t>(i)].most;
  }
  std::vector<double> evaluation, criterion, best;
  std::vector<std::string> kept;
  double least = std::numeric_limits<double>::quiet_NaN();
  for (const TriedDesign& tried : design.path) {
    const bool keeps = calcViolation(tried.score, most) <= 0.0;
    const double cost = tried.score.cost;
    least = keeps && std::isfinite(cost) && !(least <= cost) ? cost : least;
    evaluation.push_back(static_cast<double>(evaluation.size() + 1));
    criterion.push_back(cost);
    best.push_back(least);
    kept.emplace_back(keeps ? "kept" : "broken");
  }
  DataTable table;
  table.add("evaluation", std::move(evaluation));
  table.add("criterion", std::move(criterion));
  table.add("best", std::move(best));
  table.add("kept", std::move(kept));
  return table;
}

DataTable makeCorrelations(const ExcitationDesign& design) {
  const MatrixXd& covariance = design.after.limit.mean_covariance;
  std::vector<std::string> parameter, other;
  std::vector<double> correlation;
  for (Index i = 0; i < covariance.rows(); ++i) {
    for (Index j = 0; j < covariance.cols(); ++j) {
      parameter.push_back(design.parameters[static_cast<std::size_t>(i)].name.text);
      other.push_back(design.parameters[static_cast<std::size_t>(j)].name.text);
      correlation.push_back(covariance(i, j) / std::sqrt(covariance(i, i) * covariance(j, j)));
    }
  }
  DataTable table;
  table.add("parameter", std::move(parameter));
  table.add("other", std::move(other));
  table.add("correlation", std::move(correlation));
  return table;
}

Section makeBrings(const ExcitationDesign& design) {
  Section section{"brings", "What it brings", "", {}};
  section.html = makeLimitTable(
      "parameters-table",
      "The least standard deviation that any estimator can have (information limit), over the bounds.",
      design, {"before", &design.before}, {"after", &design.after});
  section.html += makeMeasureTable(design) + makeWarningList(design.warnings);
  return section;
}

Section makeRobustness(const ExcitationDesign& design) {
  Section section{"robustness", "What robustness costs and brings", "", {}};
  section.html = makeParagraph(
      fmt::format("The design that is best at the centre of the bounds alone, judged on all of the bounds "
                  "like the one averaged "
                  "over it. Mean criterion over the bounds: {:.4f} averaged, {:.4f} for the centre.",
                  design.after.limit.score.cost, design.nominal.limit.score.cost));
  section.html += makeLimitTable("robustness-table", "Limits over the bounds of both designs.", design,
                                 {"for the centre", &design.nominal}, {"averaged", &design.after});
  return section;
}

}  // namespace

std::string makeDesignPage(const ExcitationEvaluator& evaluator, const ExcitationDesign& design) {
  Page page;
  page.title = "Design of the excitation of " + evaluator.getExperiment().name.text;
  page.sections.push_back(makeBrings(design));
  Section signals{"signals", "Signals", makeSignalTable(evaluator, design), {}};
  addSignalFigures(evaluator, design, page, signals);
  page.sections.push_back(std::move(signals));
  Section correlations{"correlations", "Correlations", "", {}};
  page.tables["correlations"] = makeCorrelations(design);
  addFigure({"correlations",
             "Correlations of the errors after the design",
             "Of the mean covariance of the limit over the bounds.",
             "correlations",
             {{"correlations", {}, {{"height", calcHeatHeight(design.parameters.size())}}}},
             {},
             1},
            correlations);
  page.sections.push_back(std::move(correlations));
  Section path{"path", "What was tried", "", {}};
  page.tables["path"] = makePath(design);
  addFigure({"path",
             "The criterion of every design",
             "Lower is better; the line is the best that keeps all limits.",
             "path",
             {{"design-path"}},
             {},
             1},
            path);
  page.sections.push_back(std::move(path));
  if (design.nominal.values.size() > 0) {
    page.sections.push_back(makeRobustness(design));
  }
  return makePage(page);
}

}  // namespace twinmap::experiment_design
