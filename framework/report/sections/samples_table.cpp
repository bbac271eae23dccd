#include "framework/report/sections/samples_table.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <boost/math/special_functions/erf.hpp>
#include <cmath>

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
  values.resize(std::min(values.size(), kMostDrawnSamples));
  return values;
}

}  // namespace

double calcPit(double z) {
  return std::isnan(z) ? z : 0.5 * boost::math::erfc(-z / std::sqrt(2.0));
}

ParameterPredictions collectPredictions(const CsvTable& predictions, const std::string& parameter) {
  ParameterPredictions found;
  const bool has_limit = predictions.hasColumn("limit_stddev");
  for (std::size_t row = 0; row < predictions.rows.size(); ++row) {
    if (predictions.getText(row, "parameter") != parameter) {
      continue;
    }
    found.samples.push_back(predictions.getNumber(row, "sample"));
    found.truth.push_back(predictions.getNumber(row, "true"));
    found.inferred.push_back(predictions.getNumber(row, "inferred"));
    found.stddev.push_back(predictions.getNumber(row, "stddev"));
    if (has_limit) {
      found.limit_stddev.push_back(predictions.getNumber(row, "limit_stddev"));
    }
  }
  const auto is_known = [](double value) { return std::isfinite(value); };
  if (std::none_of(found.limit_stddev.begin(), found.limit_stddev.end(), is_known)) {
    found.limit_stddev.clear();
  }
  return found;
}

DataTable makeSamplesTable(const RunFolder& run) {
  DataTable table;
  for (const ParameterSpec& parameter : run.experiment.model.parameters) {
    const std::string& name = parameter.name.text;
    const ParameterPredictions found = collectPredictions(run.predictions, name);
    std::vector<double> error, score, pit;
    for (std::size_t i = 0; i < found.truth.size(); ++i) {
      error.push_back(found.inferred[i] - found.truth[i]);
      score.push_back(error.back() / found.stddev[i]);
      pit.push_back(calcPit(score.back()));
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
    table.add(getScoreColumn(name), takeDrawn(score));
    table.add(getPitColumn(name), takeDrawn(pit));
  }
  return table;
}

std::string describeDrawnSamples(const RunFolder& run) {
  const std::size_t count = countSamples(run.predictions);
  return count <= kMostDrawnSamples
             ? ""
             : fmt::format("The first {} of {} test samples are drawn; the table counts all. ",
                           kMostDrawnSamples, count);
}

}  // namespace twinmap
