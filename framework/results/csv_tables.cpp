#include "framework/analysis/calibration.hpp"
#include "framework/base/text/csv.hpp"
#include "framework/base/text/number_text.hpp"
#include "framework/results/tables.hpp"

namespace twinmap {
namespace {

using Row = CsvRow;

/// A column of metrics.csv and where its figure is.
struct MetricsColumn {
  std::string name;
  double ParameterFigures::*figure;
  bool left_out;
};

std::vector<MetricsColumn> listMetricsColumns(const RunSummary& run) {
  std::vector<MetricsColumn> columns, left_out;
  for (const FigureColumn& column : kFigureColumns) {
    if (!column.needs_limit || run.evaluation.limit_stddev.size() > 0) {
      columns.push_back({column.name, column.value, false});
    }
    if (column.left_out) {
      left_out.push_back({std::string("loo_") + column.name, column.value, true});
    }
  }
  columns.insert(columns.end(), left_out.begin(), left_out.end());
  return columns;
}

/// The metrics that a column shows; null where there are none.
const ParameterMetrics* findMetrics(const RunSummary& run, const MetricsColumn& column,
                                    std::size_t parameter) {
  if (!column.left_out) {
    return &run.evaluation.metrics[parameter];
  }
  return run.training.leave_one_out.empty() ? nullptr : &run.training.leave_one_out[parameter];
}

/// Of a derived quantity, which is not trained for.
Row makeDerivedRow(const DerivedEvaluation& derived, const std::vector<MetricsColumn>& columns,
                   std::size_t k) {
  const ParameterSpec& quantity = derived.quantities[k];
  const ParameterMetrics& metrics = derived.metrics[k];
  Row row{quantity.name.text, quantity.unit, toText(quantity.bounds.lower), toText(quantity.bounds.upper)};
  Row errors;
  for (const MetricsColumn& column : columns) {
    row.push_back(column.left_out ? "" : toText(metrics.*column.figure));
    errors.push_back(column.left_out ? "" : toText(metrics.se.*column.figure));
  }
  row.insert(row.end(), {"", std::to_string(metrics.samples)});
  row.insert(row.end(), errors.begin(), errors.end());
  return row;
}

Row makeMetricsRow(const RunSummary& run, const std::vector<MetricsColumn>& columns, std::size_t p) {
  const ParameterSpec& parameter = run.parameters[p];
  Row row{parameter.name.text, parameter.unit, toText(parameter.bounds.lower),
          toText(parameter.bounds.upper)};
  Row errors;
  for (const MetricsColumn& column : columns) {
    const ParameterMetrics* metrics = findMetrics(run, column, p);
    row.push_back(metrics == nullptr ? "" : toText(metrics->*column.figure));
    errors.push_back(metrics == nullptr ? "" : toText(metrics->se.*column.figure));
  }
  row.push_back(toText(run.training.nlml[p]));
  row.push_back(std::to_string(run.evaluation.metrics[p].samples));
  row.insert(row.end(), errors.begin(), errors.end());
  return row;
}

/// Columns of the predictions, each with the column of its test sample.
std::vector<std::pair<Eigen::Index, Eigen::Index>> listColumns(const RunSummary& run) {
  std::vector<std::pair<Eigen::Index, Eigen::Index>> columns;
  const auto n = static_cast<Eigen::Index>(run.test_indices.size());
  for (Eigen::Index i = 0; i < n; ++i) {
    columns.emplace_back(i, i);
  }
  for (const Eigen::Index sample : run.evaluation.predictions.repeated) {
    columns.emplace_back(static_cast<Eigen::Index>(columns.size()), sample);
  }
  return columns;
}

}  // namespace

std::string makeMetricsCsv(const RunSummary& run) {
  const std::vector<MetricsColumn> columns = listMetricsColumns(run);
  Row header{"parameter", "unit", "lower", "upper"};
  for (const MetricsColumn& column : columns) {
    header.push_back(column.name);
  }
  header.insert(header.end(), {"nlml", "test_samples"});
  for (const MetricsColumn& column : columns) {
    header.push_back(column.name + "_se");
  }
  if (run.evaluation.answers) {
    header.emplace_back("not_ok");
  }
  std::vector<Row> rows{header};
  for (std::size_t p = 0; p < run.parameters.size(); ++p) {
    rows.push_back(makeMetricsRow(run, columns, p));
  }
  if (run.evaluation.derived) {
    for (std::size_t k = 0; k < run.evaluation.derived->quantities.size(); ++k) {
      rows.push_back(makeDerivedRow(*run.evaluation.derived, columns, k));
    }
  }
  for (std::size_t i = 1; i < rows.size() && run.evaluation.answers; ++i) {
    rows[i].push_back(toText(run.evaluation.answers->calcNotOk()));
  }
  return makeCsv(rows);
}

std::string makeJointCsv(const RunSummary& run) {
  std::vector<Row> rows{{"metric", "value", "se"}};
  for (const JointColumn& column : kJointColumns) {
    rows.push_back({column.name, toText(run.evaluation.joint.*column.value),
                    toText(run.evaluation.joint.se.*column.value)});
  }
  return makeCsv(rows);
}

std::string makePitCsv(const RunSummary& run) {
  std::vector<Row> rows{{"parameter", "bin_lower", "bin_upper", "count"}};
  for (std::size_t p = 0; p < run.evaluation.pit_counts.size(); ++p) {
    for (int bin = 0; bin < kPitBins; ++bin) {
      rows.push_back({run.parameters[p].name.text, toText(double(bin) / kPitBins),
                      toText(double(bin + 1) / kPitBins), std::to_string(run.evaluation.pit_counts[p][bin])});
    }
  }
  return makeCsv(rows);
}

std::string makePredictionsCsv(const RunSummary& run) {
  const bool has_limit = run.evaluation.limit_stddev.size() > 0;
  std::vector<Row> rows{{"sample", "parameter", "true", "inferred", "stddev"}};
  if (has_limit) {
    rows[0].emplace_back("limit_stddev");
  }
  const IntervalFactors& factors = run.evaluation.predictions.interval_factors;
  if (factors.isGiven()) {
    rows[0].insert(rows[0].end(), {"interval_factor50", "interval_factor95"});
  }
  const Eigen::VectorXd& weights = run.evaluation.predictions.weights;
  if (weights.size() > 0) {
    rows[0].emplace_back("stands_for");
  }
  for (const auto& [column, sample] : listColumns(run)) {
    for (std::size_t p = 0; p < run.parameters.size(); ++p) {
      const auto row = static_cast<Eigen::Index>(p);
      rows.push_back({std::to_string(run.test_indices[static_cast<std::size_t>(sample)]),
                      run.parameters[p].name.text, toText(run.evaluation.truth(row, sample)),
                      toText(run.evaluation.predictions.mean(row, column)),
                      toText(run.evaluation.predictions.stddev(row, column))});
      if (has_limit) {
        rows.back().push_back(toText(run.evaluation.limit_stddev(row, sample)));
      }
      if (factors.isGiven()) {
        rows.back().insert(rows.back().end(),
                           {toText(factors.of50(row, column)), toText(factors.of95(row, column))});
      }
      if (weights.size() > 0) {
        rows.back().push_back(toText(weights[column]));
      }
    }
  }
  return makeCsv(rows);
}

std::string makeDerivedCsv(const RunSummary& run) {
  const DerivedEvaluation& derived = *run.evaluation.derived;
  const bool has_limit = derived.limit_stddev.size() > 0;
  std::vector<Row> rows{{"sample", "parameter", "true", "inferred", "stddev", "lower", "upper"}};
  if (has_limit) {
    rows[0].emplace_back("limit_stddev");
  }
  for (Eigen::Index i = 0; i < derived.truth.cols(); ++i) {
    for (Eigen::Index k = 0; k < derived.truth.rows(); ++k) {
      rows.push_back({std::to_string(run.test_indices[static_cast<std::size_t>(i)]),
                      derived.quantities[static_cast<std::size_t>(k)].name.text, toText(derived.truth(k, i)),
                      toText(derived.mean(k, i)), toText(derived.stddev(k, i)), toText(derived.lower95(k, i)),
                      toText(derived.upper95(k, i))});
      if (has_limit) {
        rows.back().push_back(toText(derived.limit_stddev(k, i)));
      }
    }
  }
  return makeCsv(rows);
}

std::string makeCurvesCsv(const RunSummary& run) {
  const CurveEstimates& curves = run.evaluation.curves;
  const DerivedEvaluation& values = curves.values;
  std::vector<Row> rows{{"sample", "curve", "argument", "true", "inferred", "lower", "upper"}};
  for (Eigen::Index i = 0; i < values.truth.cols(); ++i) {
    for (Eigen::Index k = 0; k < values.truth.rows(); ++k) {
      const auto point = static_cast<std::size_t>(k);
      rows.push_back({std::to_string(run.test_indices[static_cast<std::size_t>(i)]), curves.curves[point],
                      toText(curves.arguments[point]), toText(values.truth(k, i)), toText(values.mean(k, i)),
                      toText(values.lower95(k, i)), toText(values.upper95(k, i))});
    }
  }
  return makeCsv(rows);
}

std::string makeComponentsCsv(const RunSummary& run) {
  std::vector<Row> rows{{"sample", "component", "weight", "parameter", "mean", "stddev"}};
  const std::vector<Mixture>& mixtures = run.evaluation.predictions.mixtures;
  for (const auto& [column, of] : listColumns(run)) {
    const Mixture& mixture = mixtures[static_cast<std::size_t>(column)];
    const std::string sample = std::to_string(run.test_indices[static_cast<std::size_t>(of)]);
    for (Eigen::Index c = 0; c < mixture.countComponents(); ++c) {
      for (std::size_t p = 0; p < run.parameters.size(); ++p) {
        const auto row = static_cast<Eigen::Index>(p);
        rows.push_back({sample, std::to_string(c), toText(mixture.weights[c]), run.parameters[p].name.text,
                        toText(mixture.means(row, c)), toText(mixture.stddevs(row, c))});
      }
    }
  }
  return makeCsv(rows);
}

std::string makeFailuresCsv(const std::vector<ParameterSpec>& sampled,
                            const std::vector<FailedSample>& failures) {
  Row header{"set", "sample"};
  for (const ParameterSpec& parameter : sampled) {
    header.push_back(parameter.name.text);
  }
  header.emplace_back("reason");
  std::vector<Row> rows{header};
  for (const FailedSample& failure : failures) {
    Row row{failure.set, std::to_string(failure.sample)};
    for (const double value : failure.parameters) {
      row.push_back(toText(value));
    }
    row.push_back(failure.reason);
    rows.push_back(row);
  }
  return makeCsv(rows);
}

std::string makeCrossValidationCsv(const RunSummary& run) {
  std::vector<Row> rows{{"parameter", "coverage95", "stddev_scale", "log_density", "status", "limit_ratio",
                         "halved_to", "error_ratio", "interval_factor50", "interval_factor95"}};
  const CrossValidation& found = *run.training.cross_validation;
  for (std::size_t p = 0; p < run.parameters.size(); ++p) {
    const auto row = static_cast<Eigen::Index>(p);
    rows.push_back({run.parameters[p].name.text, toText(found.coverage95[row]),
                    toText(found.stddev_scale[row]), toText(found.log_density), found.status,
                    toText(found.limit_ratio[row]), found.half > 0 ? std::to_string(found.half) : "",
                    found.half > 0 ? toText(found.error_ratio[row]) : "",
                    toText(found.interval_factors.get(row).of50),
                    toText(found.interval_factors.get(row).of95)});
  }
  return makeCsv(rows);
}

std::string makeChainsCsv(const SampledChains& sampled) {
  std::vector<Row> rows{{"quantity", "r_hat", "effective_draws", "weights", "chains", "draws", "divergences",
                         "cut", "acceptance"}};
  for (const SampledQuantity& quantity : sampled.quantities) {
    rows.push_back({quantity.name, toText(quantity.r_hat), toText(quantity.effective_draws),
                    std::to_string(sampled.weights), std::to_string(sampled.chains),
                    std::to_string(sampled.draws), std::to_string(sampled.divergences),
                    std::to_string(sampled.cut), toText(sampled.acceptance)});
  }
  return makeCsv(rows);
}

std::string makeHyperparametersCsv(const RunSummary& run) {
  std::vector<Row> rows{{"parameter", "hyperparameter", "value", "lower", "upper"}};
  for (const TrainedHyperparameter& trained : run.training.hyperparameters) {
    rows.push_back({trained.parameter, trained.name, toText(trained.value), toText(trained.lower),
                    toText(trained.upper)});
  }
  return makeCsv(rows);
}

std::string makeTrainingCsv(const RunSummary& run) {
  std::vector<Row> rows{{"parameter", "start", "best", "nlml", "evaluations", "noise_only", "stop_reason",
                         "at_bound", "condition", "jitter"}};
  for (const TrainingStart& start : run.training.starts) {
    rows.push_back({start.parameter, std::to_string(start.start), start.best ? "1" : "0", toText(start.nlml),
                    std::to_string(start.evaluations), start.noise_only ? "1" : "0", start.stop_reason,
                    start.at_bound, start.best ? toText(start.condition) : "",
                    start.best ? toText(start.jitter) : ""});
  }
  return makeCsv(rows);
}

}  // namespace twinmap
