#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "framework/experiment/check/known_names.hpp"
#include "framework/experiment/parameter_figures.hpp"
#include "framework/report/html.hpp"
#include "framework/report/sections/sections.hpp"

namespace twinmap {
namespace {

/// How far each start ended above the best of its parameter, in nats.
std::vector<double> calcAboveBest(const CsvTable& training) {
  std::vector<double> above;
  for (std::size_t row = 0; row < training.rows.size(); ++row) {
    double best = HUGE_VAL;
    for (std::size_t other = 0; other < training.rows.size(); ++other) {
      const bool same = training.getText(other, "parameter") == training.getText(row, "parameter");
      best = same ? std::fmin(best, training.getNumber(other, "nlml")) : best;
    }
    above.push_back(std::max(training.getNumber(row, "nlml") - best, 0.0));
  }
  return above;
}

DataTable makeStartsTable(const CsvTable& training) {
  std::vector<std::string> found;
  for (const std::string& best : training.listTexts("best")) {
    found.emplace_back(best == "1" ? "kept" : "other start");
  }
  DataTable table;
  table.add("parameter", training.listTexts("parameter"));
  table.add("start", training.listNumbers("start"));
  table.add("found", std::move(found));
  table.add("nlml", training.listNumbers("nlml"));
  table.add("above_best", calcAboveBest(training));
  return table;
}

/// At least 1 nat.
double findFurthestStart(const CsvTable& training) {
  double furthest = 1.0;
  for (const double above : calcAboveBest(training)) {
    furthest = std::isfinite(above) ? std::max(furthest, above) : furthest;
  }
  return furthest;
}

void addStarts(const RunFolder& run, Section& section, Page& page) {
  constexpr int kRowHeight = 30, kFrame = 20;
  const std::vector<std::string> names = collectNames(run.experiment.model.parameters);
  page.tables["starts"] = makeStartsTable(run.training);
  addFigure({"starts",
             "Searches for hyperparameters",
             "Each mark is the end of one search; several at the left mean that different starts agree on "
             "the optimum, one far to the right ended in a worse one and was discarded.",
             "starts",
             {{"starts",
               {},
               {{"height", calcHeight(names.size(), kRowHeight, kFrame)},
                {"furthest", findFurthestStart(run.training)},
                {"parameters", names}}}},
             {},
             1},
            section);
}

std::string makeTrainingTable(const CsvTable& training) {
  CsvTable kept{training.columns, {}};
  const auto at_bound = static_cast<std::size_t>(std::max(0, training.findColumn("at_bound")));
  for (std::size_t row = 0; row < training.rows.size(); ++row) {
    if (training.getText(row, "best") == "1") {
      kept.rows.push_back(training.rows[row]);
      std::string& bounds = kept.rows.back()[at_bound];
      bounds = bounds.empty() ? "none" : bounds;
    }
  }
  return makeHtmlTable("training-table", "The start that was kept.", kept,
                       {{"parameter", "parameter"},
                        {"nlml", "NLML [nats]", 6},
                        {"evaluations", "evaluations", 6},
                        {"stop_reason", "why it stopped"},
                        {"at_bound", "at a bound"},
                        {"condition", "condition", 3},
                        {"jitter", "jitter", 3}}) +
         makeParagraph(
             "A condition above 1e12 or a jitter above 0 means that the covariance matrix is nearly "
             "singular: raise the lower bound of noise_stddev.",
             "class=\"quiet\"");
}

DataTable makeHyperparameterTable(const CsvTable& hyperparameters) {
  std::vector<double> place;
  for (std::size_t row = 0; row < hyperparameters.rows.size(); ++row) {
    const double lower = hyperparameters.getNumber(row, "lower");
    place.push_back(std::log(hyperparameters.getNumber(row, "value") / lower) /
                    std::log(hyperparameters.getNumber(row, "upper") / lower));
  }
  DataTable table;
  table.add("parameter", hyperparameters.listTexts("parameter"));
  table.add("hyperparameter", hyperparameters.listTexts("hyperparameter"));
  for (const char* column : {"value", "lower", "upper"}) {
    table.add(column, hyperparameters.listNumbers(column));
  }
  table.add("place", std::move(place));
  return table;
}

void addHyperparameters(const RunFolder& run, Section& section, Page& page) {
  if (run.hyperparameters.empty()) {
    return;
  }
  page.tables["hyperparameters"] = makeHyperparameterTable(run.hyperparameters);
  Figure figure{
      "hyperparameters",
      "Hyperparameters within their bounds",
      "Where each hyperparameter lies between its lower bound (left) and its upper bound (right), on a "
      "logarithmic scale; one at an edge asks for wider bounds, or says that an input is irrelevant.",
      "hyperparameters",
      {},
      {},
      0};
  const std::vector<std::string> names = collectNames(run.experiment.model.parameters);
  const std::size_t count = std::max<std::size_t>(1, run.hyperparameters.rows.size() / names.size());
  figure.columns = names.size() == 4 ? 2 : 0;
  constexpr int kRowHeight = 18, kFrame = 20;
  constexpr std::size_t kMaxRows = 30;  // beyond, rows share the height
  for (std::size_t p = 0; p < names.size(); ++p) {
    figure.panels.push_back({"hyperparameters",
                             {{"name", names[p]}, {"color", getColor(p)}},
                             {{"height", calcHeight(std::min(count, kMaxRows), kRowHeight, kFrame)}}});
  }
  addFigure(std::move(figure), section);
}

/// How well the chains know a network whose weights were sampled.
std::string makeChains(const CsvTable& chains) {
  return makeElement("h3", "Draws of the network's weights") + "\n" +
         makeHtmlTable(
             "chains-table",
             fmt::format("{} chains of {} draws of {} weights; {} divergent trajectories, {} cut, mean "
                         "acceptance {:.2f}. Of a parameter: the worst of its means at 20 samples.",
                         chains.getText(0, "chains"), chains.getText(0, "draws"),
                         chains.getText(0, "weights"), chains.getText(0, "divergences"),
                         chains.getText(0, "cut"), chains.getNumber(0, "acceptance")),
             chains, {{"quantity", "quantity"}, {"r_hat", "R-hat"}, {"effective_draws", "effective draws"}}) +
         makeParagraph(
             "R-hat is 1 where the chains agree; above 1.05, or with fewer than 100 effective draws, they do "
             "not know the posterior yet.",
             "class=\"quiet\"");
}

/// Leave-one-out figures from training alone, beside those on the test set.
/// Of the parameters, whose rows come before those of derived quantities.
std::string makeLeaveOneOut(CsvTable metrics, std::size_t parameters) {
  metrics.rows.resize(std::min(metrics.rows.size(), parameters));
  std::vector<ShownColumn> columns{{"parameter", "parameter"}};
  for (const FigureColumn& column : kFigureColumns) {
    const std::string name = column.name, heading = column.heading;
    if (column.left_out && metrics.hasColumn("loo_" + name)) {
      columns.push_back({"loo_" + name, heading + ", left out"});
      columns.push_back({name, heading + ", test"});
    }
  }
  if (columns.size() == 1) {
    return "";
  }
  return makeElement("h3", "Leave-one-out beside test") + "\n" +
         makeHtmlTable("loo-table",
                       "Each training sample estimated from the others, without a test set: where both "
                       "columns agree, training alone shows how good the estimator is.",
                       metrics, columns);
}

}  // namespace

void addTraining(const RunFolder& run, Page& page) {
  if (run.training.empty() && run.chains.empty()) {
    return;
  }
  Section section{"training", "Training health", "", {}};
  if (!run.training.empty()) {
    addStarts(run, section, page);
    section.html += makeTrainingTable(run.training);
  }
  if (!run.chains.empty()) {
    section.html += makeChains(run.chains);
  }
  addHyperparameters(run, section, page);
  section.html += makeLeaveOneOut(run.metrics, run.experiment.model.parameters.size());
  page.sections.push_back(std::move(section));
}

}  // namespace twinmap
