#include "framework/report/sections/samples_table.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <boost/math/special_functions/erf.hpp>
#include <cmath>

#include "framework/analysis/calibration.hpp"

namespace twinmap {
namespace {

std::size_t countSamples(const CsvTable& predictions) {
  std::size_t count = 0;
  for (std::size_t row = 0; row < predictions.rows.size(); ++row) {
    count += predictions.getText(row, "parameter") == predictions.getText(0, "parameter") ? 1 : 0;
  }
  return count;
}

std::vector<double> takeDrawn(std::vector<double> values) {
  values.resize(std::min(values.size(), kMaxDrawnSamples));
  return values;
}

Eigen::Index findRow(const RunFolder& run, const std::string& name) {
  const std::vector<ParameterSpec>& parameters = run.experiment.model.parameters;
  const auto found = std::find_if(parameters.begin(), parameters.end(),
                                  [&](const ParameterSpec& one) { return one.name.text == name; });
  return found - parameters.begin();
}

std::vector<double> calcScores(const RunFolder& run, const std::string& parameter,
                               const ParameterPredictions& found) {
  const Eigen::Index row = findRow(run, parameter);
  std::vector<double> scores;
  for (std::size_t i = 0; i < found.truth.size(); ++i) {
    scores.push_back(
        run.mixtures.empty()
            ? (found.inferred[i] - found.truth[i]) / found.stddev[i]
            : -calcNormalQuantile(takeMarginal(run.mixtures[i], row).calcProbability(found.truth[i])));
  }
  return scores;
}

}  // namespace

double calcPit(double z) {
  return std::isnan(z) ? z : 0.5 * boost::math::erfc(-z / std::sqrt(2.0));
}

ParameterPredictions collectPredictions(const RunFolder& run, const std::string& parameter) {
  const std::vector<std::size_t> rows = run.predictions.findRows("parameter", parameter);
  const auto list = [&](const char* column) { return run.predictions.listNumbers(column, rows); };
  ParameterPredictions found{list("sample"), list("true"), list("inferred"),
                             list("stddev"), {},           list("limit_stddev")};
  const auto is_known = [](double value) { return std::isfinite(value); };
  if (std::none_of(found.limit_stddev.begin(), found.limit_stddev.end(), is_known)) {
    found.limit_stddev.clear();
  }
  found.z = calcScores(run, parameter, found);
  return found;
}

DataTable makeSamplesTable(const RunFolder& run) {
  DataTable table;
  for (const ParameterSpec& parameter : run.experiment.model.parameters) {
    const std::string& name = parameter.name.text;
    const ParameterPredictions found = collectPredictions(run, name);
    std::vector<double> error, pit;
    for (std::size_t i = 0; i < found.truth.size(); ++i) {
      error.push_back(found.inferred[i] - found.truth[i]);
      pit.push_back(calcPit(found.z[i]));
    }
    if (!table.hasColumn("sample")) {
      table.add("sample", takeDrawn(found.samples));
    }
    table.add(getTrueColumn(name), takeDrawn(found.truth));
    table.add(getInferredColumn(name), takeDrawn(found.inferred));
    table.add(getStddevColumn(name), takeDrawn(found.stddev));
    if (!found.limit_stddev.empty()) {
      table.add(getLimitColumn(name), takeDrawn(found.limit_stddev));
    }
    table.add(getErrorColumn(name), takeDrawn(error));
    table.add(getScoreColumn(name), takeDrawn(found.z));
    table.add(getPitColumn(name), takeDrawn(pit));
  }
  return table;
}

std::string describeDrawnSamples(const RunFolder& run) {
  const std::size_t count = countSamples(run.predictions);
  return count <= kMaxDrawnSamples
             ? ""
             : fmt::format("The first {} of {} test samples are drawn; the table counts all. ",
                           kMaxDrawnSamples, count);
}

Choice makeParameterChoice(const std::string& name, const std::string& label,
                           const std::vector<ParameterSpec>& parameters, std::size_t chosen) {
  Choice choice{name, label, {}, chosen};
  for (const ParameterSpec& parameter : parameters) {
    choice.options.push_back(
        {parameter.name.text, makeLabel(parameter), {parameter.bounds.lower, parameter.bounds.upper}});
  }
  return choice;
}

std::map<std::string, SlotValue> makeChosenDomains() {
  return {{"x_domain", std::string("{x.domain}")}, {"y_domain", std::string("{y.domain}")}};
}

}  // namespace twinmap
