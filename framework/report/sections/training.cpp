#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "framework/experiment/check/check_experiment.hpp"
#include "framework/report/html.hpp"
#include "framework/report/sections/sections.hpp"

namespace twinmap {
namespace {

double findBestNlml(const CsvTable& training, const std::string& parameter) {
  double best = HUGE_VAL;
  for (std::size_t row = 0; row < training.rows.size(); ++row) {
    const double nlml = training.getNumber(row, "nlml");
    if (training.getText(row, "parameter") == parameter && nlml < best) {
      best = nlml;
    }
  }
  return best;
}

DataTable makeStartsTable(const CsvTable& training) {
  std::vector<std::string> parameter, found;
  std::vector<double> start, nlml, above;
  for (std::size_t row = 0; row < training.rows.size(); ++row) {
    parameter.push_back(training.getText(row, "parameter"));
    found.push_back(training.getText(row, "best") == "1" ? "kept" : "other start");
    start.push_back(training.getNumber(row, "start"));
    nlml.push_back(training.getNumber(row, "nlml"));
    above.push_back(std::max(nlml.back() - findBestNlml(training, parameter.back()), 0.0));
  }
  DataTable table;
  table.add("parameter", parameter);
  table.add("start", start);
  table.add("found", found);
  table.add("nlml", nlml);
  table.add("above_best", above);
  return table;
}

/// How far the worst start ended above the best of its parameter; at least 1 nat.
double findFurthestStart(const CsvTable& training) {
  double furthest = 1.0;
  for (std::size_t row = 0; row < training.rows.size(); ++row) {
    const double above =
        training.getNumber(row, "nlml") - findBestNlml(training, training.getText(row, "parameter"));
    furthest = std::isfinite(above) ? std::max(furthest, above) : furthest;
  }
  return furthest;
}

void addStarts(const RunFolder& run, Section& section, Page& page) {
  constexpr int kRowHeight = 30, kFrame = 20;
  const std::vector<std::string> names = collectNames(run.experiment.model.parameters);
  page.tables["starts"] = makeStartsTable(run.training);
  addFigure(
      {"starts",
       "Searches for hyperparameters",
       "Each mark is the end of one search; several at the left mean that different starts agree on the "
       "optimum, one far to the right ended in a worse one and was discarded.",
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
  std::vector<std::vector<HtmlCell>> rows;
  for (std::size_t row = 0; row < training.rows.size(); ++row) {
    if (training.getText(row, "best") != "1") {
      continue;
    }
    const std::string& at_bound = training.getText(row, "at_bound");
    rows.push_back({makeTextCell(training.getText(row, "parameter")),
                    makeNumberCell(training.getText(row, "nlml"), 6),
                    makeNumberCell(training.getText(row, "evaluations"), 6),
                    makeTextCell(training.getText(row, "stop_reason")),
                    makeTextCell(at_bound.empty() ? "none" : at_bound),
                    makeNumberCell(training.getText(row, "condition"), 3),
                    makeNumberCell(training.getText(row, "jitter"), 3)});
  }
  return makeHtmlTable("training-table", "The start that was kept.",
                       {"parameter", "NLML [nats]", "evaluations", "why it stopped", "at a bound",
                        "condition", "jitter"},
                       rows) +
         makeParagraph(
             "A condition above 1e12 or a jitter above 0 means that the covariance matrix is nearly "
             "singular: "
             "raise the lower bound of noise_stddev.",
             "class=\"quiet\"");
}

DataTable makeHyperparameterTable(const CsvTable& hyperparameters) {
  std::vector<std::string> parameter, name;
  std::vector<double> value, lower, upper, place;
  for (std::size_t row = 0; row < hyperparameters.rows.size(); ++row) {
    parameter.push_back(hyperparameters.getText(row, "parameter"));
    name.push_back(hyperparameters.getText(row, "hyperparameter"));
    value.push_back(hyperparameters.getNumber(row, "value"));
    lower.push_back(hyperparameters.getNumber(row, "lower"));
    upper.push_back(hyperparameters.getNumber(row, "upper"));
    place.push_back(std::log(value.back() / lower.back()) / std::log(upper.back() / lower.back()));
  }
  DataTable table;
  table.add("parameter", parameter);
  table.add("hyperparameter", name);
  table.add("value", value);
  table.add("lower", lower);
  table.add("upper", upper);
  table.add("place", place);
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
  std::vector<std::vector<HtmlCell>> rows;
  for (std::size_t row = 0; row < chains.rows.size(); ++row) {
    rows.push_back({makeTextCell(chains.getText(row, "quantity")),
                    makeNumberCell(chains.getText(row, "r_hat"), 4),
                    makeNumberCell(chains.getText(row, "effective_draws"), 4)});
  }
  return makeElement("h3", "Draws of the network's weights") + "\n" +
         makeHtmlTable(
             "chains-table",
             fmt::format("{} chains of {} draws of {} weights; {} divergent trajectories, {} cut, mean "
                         "acceptance {:.2f}. Of a parameter: the worst of its means at 20 samples.",
                         chains.getText(0, "chains"), chains.getText(0, "draws"),
                         chains.getText(0, "weights"), chains.getText(0, "divergences"),
                         chains.getText(0, "cut"), chains.getNumber(0, "acceptance")),
             {"quantity", "R-hat", "effective draws"}, rows) +
         makeParagraph(
             "R-hat is 1 where the chains agree; above 1.05, or with fewer than 100 effective draws, "
             "they do not know the posterior yet.",
             "class=\"quiet\"");
}

/// Leave-one-out figures from training alone, beside those on the test set.
std::string makeLeaveOneOut(const CsvTable& metrics) {
  const std::vector<std::pair<std::string, std::string>> pairs{
      {"loo_sd_pct", "sd_pct"}, {"loo_coverage95", "coverage95"}, {"loo_z_sd", "z_sd"}, {"loo_nlpd", "nlpd"}};
  std::vector<std::string> headings{"parameter"};
  std::vector<std::vector<HtmlCell>> rows(metrics.rows.size());
  for (std::size_t row = 0; row < rows.size(); ++row) {
    rows[row].push_back(makeTextCell(metrics.getText(row, "parameter")));
  }
  for (const auto& [left_out, test] : pairs) {
    if (!metrics.hasColumn(left_out)) {
      continue;
    }
    headings.push_back(test + ", left out");
    headings.push_back(test + ", test");
    for (std::size_t row = 0; row < rows.size(); ++row) {
      rows[row].push_back(makeNumberCell(metrics.getText(row, left_out)));
      rows[row].push_back(makeNumberCell(metrics.getText(row, test)));
    }
  }
  if (headings.size() == 1) {
    return "";
  }
  return makeElement("h3", "Leave-one-out beside test") + "\n" +
         makeHtmlTable(
             "loo-table",
             "Each training sample inferred from the others, without a test set: where both columns agree, "
             "training alone tells how good the map is.",
             headings, rows);
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
  section.html += makeLeaveOneOut(run.metrics);
  page.sections.push_back(std::move(section));
}

}  // namespace twinmap
