#include "framework/results/result_files.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "framework/base/files/atomic_file.hpp"
#include "framework/base/text/csv.hpp"
#include "framework/base/text/number_text.hpp"
#include "framework/results/tables.hpp"
#include "framework/results/warnings.hpp"

namespace twinmap {

namespace fs = std::filesystem;

namespace {

using Eigen::Index;

CsvRow addParameterNames(CsvRow header, const RunSummary& run) {
  for (const ParameterSpec& parameter : run.parameters) {
    header.push_back(parameter.name.text);
  }
  return header;
}

CsvRow addNumbers(CsvRow row, const Eigen::VectorXd& values) {
  for (const double value : values) {
    row.push_back(toText(value));
  }
  return row;
}

std::string toCell(double value) {
  return std::isfinite(value) ? toText(value) : "";
}

CsvRow addFigureNames(CsvRow header, bool with_limit = true) {
  for (const FigureColumn& column : kFigureColumns) {
    if (with_limit || !column.needs_limit) {
      header.emplace_back(column.name);
    }
  }
  return header;
}

/// All figures of a parameter; an empty cell for one that is not known.
CsvRow addFigures(CsvRow row, const ParameterFigures& figures, bool with_limit = true) {
  for (const FigureColumn& column : kFigureColumns) {
    if (with_limit || !column.needs_limit) {
      row.push_back(toCell(figures.*column.value));
    }
  }
  return row;
}

/// The method of a test sample's answer and its statuses; empty of one that was not sampled but would be.
void addAnswer(const std::optional<AnswerSummary>& answers, std::size_t sample, CsvRow& row) {
  const bool is_known = answers && answers->weights[static_cast<Index>(sample)] > 0.0;
  std::string statuses;
  for (const std::string& status :
       is_known ? answers->answers[sample].statuses : std::vector<std::string>()) {
    statuses += (statuses.empty() ? "" : "; ") + status;
  }
  row.insert(row.end(), {is_known ? answers->answers[sample].method : "", statuses});
}

/// features.csv: feature, unit, output time, noise_stddev, then for each parameter the root mean square over
/// the test set of the feature's change per width of the bounds, in standard deviations of its noise.
std::string makeFeaturesCsv(const RunSummary& run) {
  std::vector<CsvRow> rows{addParameterNames({"feature", "unit", "output", "time", "noise_stddev"}, run)};
  const FeatureRelevance& features = *run.evaluation.relevance;
  for (std::size_t f = 0; f < features.infos.size(); ++f) {
    const FeatureInfo& info = features.infos[f];
    const auto index = static_cast<Index>(f);
    rows.push_back(addNumbers({info.name, info.unit, info.output < 0 ? "" : std::to_string(info.output),
                               toText(info.time), toText(features.noise_stddev[index])},
                              features.relevance.row(index)));
  }
  return makeCsv(rows);
}

/// correlations.csv: parameter, then a column for each parameter.
std::string makeCorrelationsCsv(const RunSummary& run) {
  std::vector<CsvRow> rows{addParameterNames({"parameter"}, run)};
  for (std::size_t p = 0; p < run.parameters.size(); ++p) {
    rows.push_back(addNumbers({run.parameters[p].name.text},
                              run.evaluation.identifiability->correlation.row(static_cast<Index>(p))));
  }
  return makeCsv(rows);
}

/// identifiability.csv: an eigenvalue of the mean Fisher information a row, ascending, then the entries of
/// its eigenvector, a column for each parameter.
std::string makeIdentifiabilityCsv(const RunSummary& run) {
  std::vector<CsvRow> rows{addParameterNames({"eigenvalue"}, run)};
  const Identifiability& found = *run.evaluation.identifiability;
  for (Index k = 0; k < found.eigenvalues.size(); ++k) {
    rows.push_back(addNumbers({toText(found.eigenvalues[k])}, found.eigenvectors.col(k)));
  }
  return makeCsv(rows);
}

/// identified.csv: of parameters that are not determined one by one a row for each combination that is, with
/// what to name it below `derived`; columns parameters (separated by spaces), undetermined (how many stay
/// so), name, expression, unit, residual (Combination::residual).
std::string makeIdentifiedCsv(const RunSummary& run) {
  std::vector<CsvRow> rows{{"parameters", "undetermined", "name", "expression", "unit", "residual"}};
  for (const Ridge& ridge : run.evaluation.ridges) {
    std::string names;
    for (const Index j : ridge.parameters) {
      names += (names.empty() ? "" : " ") + run.parameters[static_cast<std::size_t>(j)].name.text;
    }
    const std::string dimension = std::to_string(ridge.dimension);
    for (const DerivedEntry& entry : listDerived({ridge}, run.parameters)) {
      rows.push_back({names, dimension, entry.name, entry.expression, entry.unit, toText(entry.residual)});
    }
    if (ridge.combinations.empty()) {
      rows.push_back({names, dimension, "", "", "", ""});
    }
  }
  return makeCsv(rows);
}

/// posterior.csv: sample, parameter, posterior_mean, posterior_stddev, map_mean, map_stddev, limit_stddev,
/// effective_sample_size, simulations.
std::string makePosteriorCsv(const RunSummary& run) {
  std::vector<CsvRow> rows{{"sample", "parameter", "posterior_mean", "posterior_stddev", "map_mean",
                            "map_stddev", "limit_stddev", "effective_sample_size", "simulations"}};
  for (const PosteriorComparison& row : run.evaluation.posteriors) {
    for (std::size_t p = 0; p < run.parameters.size(); ++p) {
      const auto j = static_cast<Index>(p);
      rows.push_back({std::to_string(row.sample), run.parameters[p].name.text, toText(row.mean[j]),
                      toText(row.stddev[j]), toText(row.map_mean[j]), toText(row.map_stddev[j]),
                      row.limit_stddev.size() > 0 ? toText(row.limit_stddev[j]) : "",
                      toText(row.effective_sample_size), std::to_string(row.simulations)});
    }
  }
  return makeCsv(rows);
}

/// sbc.csv: quantity (a parameter, or "joint"), bin, lower, upper (of the ranks' share), count, expected,
/// measurements, unreliable, chi_square, p_value.
std::string makeSbcCsv(const RunSummary& run) {
  const PosteriorCalibration& found = *run.evaluation.calibration;
  const Index bins = found.ranks.counts.rows();
  const auto share = [&](Index bin) { return toText(static_cast<double>(bin) / static_cast<double>(bins)); };
  std::vector<CsvRow> rows{{"quantity", "bin", "lower", "upper", "count", "expected", "measurements",
                            "unreliable", "chi_square", "p_value"}};
  for (Index q = 0; q < found.ranks.counts.cols(); ++q) {
    const auto p = static_cast<std::size_t>(q);
    for (Index bin = 0; bin < bins; ++bin) {
      rows.push_back({p < run.parameters.size() ? run.parameters[p].name.text : "joint", std::to_string(bin),
                      share(bin), share(bin + 1), std::to_string(found.ranks.counts(bin, q)),
                      toText(static_cast<double>(found.measurements) / static_cast<double>(bins)),
                      std::to_string(found.measurements), std::to_string(found.unreliable),
                      toText(found.ranks.chi_square[q]), toText(found.ranks.p_value[q])});
    }
  }
  return makeCsv(rows);
}

/// baselines.csv: method, samples, parameter, bias_pct, sd_pct, mare_pct, coverage50, coverage90, coverage95,
/// seconds_per_update, unconverged.
std::string makeBaselinesCsv(const RunSummary& run) {
  std::vector<CsvRow> rows{addFigureNames({"method", "samples", "parameter"}, false)};
  rows[0].insert(rows[0].end(), {"seconds_per_update", "unconverged"});
  for (const BaselineSummary& baseline : run.evaluation.baselines) {
    for (std::size_t p = 0; p < run.parameters.size(); ++p) {
      rows.push_back(
          addFigures({baseline.method, std::to_string(baseline.samples), run.parameters[p].name.text},
                     baseline.metrics[p], false));
      rows.back().insert(rows.back().end(),
                         {toText(baseline.seconds_per_update), std::to_string(baseline.unconverged)});
    }
  }
  return makeCsv(rows);
}

/// maps.csv: map, parameter, bias_pct, sd_pct, mare_pct, limit_pct, ratio_to_limit, coverage50, coverage90,
/// coverage95, nlpd, joint_coverage95, joint_nlpd, training_seconds, online_us (median of one measurement),
/// bytes.
std::string makeMapsCsv(const RunSummary& run) {
  std::vector<CsvRow> rows{addFigureNames({"map", "parameter"})};
  rows[0].insert(rows[0].end(), {"joint_coverage95", "joint_nlpd", "training_seconds", "online_us", "bytes"});
  for (const MapComparison& map : run.evaluation.maps) {
    for (std::size_t p = 0; p < run.parameters.size(); ++p) {
      rows.push_back(addFigures({map.name, run.parameters[p].name.text}, map.metrics[p]));
      for (const double value :
           {map.joint.coverage95, map.joint.nlpd, map.training_seconds, map.online.median_us}) {
        rows.back().push_back(toCell(value));
      }
      rows.back().push_back(std::to_string(map.bytes));
    }
  }
  return makeCsv(rows);
}

/// methods.csv: method, parameter, bias_pct, sd_pct, mare_pct, limit_pct, ratio_to_limit, coverage50,
/// coverage90, coverage95, samples, accepted (share), median_simulations; figures are those of the accepted
/// samples, the limit too.
std::string makeMethodsCsv(const RunSummary& run) {
  std::vector<CsvRow> rows{addFigureNames({"method", "parameter"})};
  rows[0].insert(rows[0].end(), {"samples", "accepted", "median_simulations", "apart_from_posterior"});
  for (const MethodSummary& method : run.evaluation.methods) {
    const double share = static_cast<double>(method.accepted) / static_cast<double>(method.samples);
    for (std::size_t p = 0; p < run.parameters.size(); ++p) {
      CsvRow row = addFigures({method.method, run.parameters[p].name.text}, method.metrics[p]);
      if (method.accepted == 0) {
        std::fill(row.begin() + 2, row.end(), "");
      }
      row.insert(row.end(),
                 {std::to_string(method.samples), toText(share), std::to_string(method.median_simulations),
                  method.apart_from_posterior ? toText(*method.apart_from_posterior) : ""});
      rows.push_back(std::move(row));
    }
  }
  return makeCsv(rows);
}

/// refined.csv: sample, status, start, chi_square, distance, iterations, simulations, message, answer,
/// statuses; then for each parameter NAME_true, NAME_refined, NAME_stddev, the last two only where it is
/// accepted.
std::string makeRefinedCsv(const RunSummary& run) {
  CsvRow header{"sample",     "status",      "start",   "chi_square", "distance",
                "iterations", "simulations", "message", "answer",     "statuses"};
  for (const ParameterSpec& parameter : run.parameters) {
    for (const char* column : {"_true", "_refined", "_stddev"}) {
      header.push_back(parameter.name.text + column);
    }
  }
  std::vector<CsvRow> rows{header};
  for (std::size_t i = 0; i < run.evaluation.refined.size(); ++i) {
    const Refined& one = run.evaluation.refined[i];
    rows.push_back({std::to_string(run.test_indices[i]), toString(one.status), one.start,
                    toText(one.chi_square), toText(one.distance), std::to_string(one.iterations),
                    std::to_string(one.simulations), one.message});
    addAnswer(run.evaluation.answers, i, rows.back());
    for (Index j = 0; j < run.evaluation.truth.rows(); ++j) {
      rows.back().push_back(toText(run.evaluation.truth(j, static_cast<Index>(i))));
      rows.back().push_back(one.isAccepted() ? toText(one.mean[j]) : "");
      rows.back().push_back(one.isAccepted() ? toText(one.stddev[j]) : "");
    }
  }
  return makeCsv(rows);
}

void writeEvaluation(const fs::path& folder, const RunSummary& run) {
  if (run.evaluation.relevance) {
    writeTextFile(folder / "features.csv", makeFeaturesCsv(run));
    writeTextFile(folder / "correlations.csv", makeCorrelationsCsv(run));
    writeTextFile(folder / "identifiability.csv", makeIdentifiabilityCsv(run));
  }
  if (!run.evaluation.ridges.empty()) {
    writeTextFile(folder / "identified.csv", makeIdentifiedCsv(run));
  }
  if (run.evaluation.derived) {
    writeTextFile(folder / "derived.csv", makeDerivedCsv(run));
  }
  if (!run.evaluation.curves.curves.empty()) {
    writeTextFile(folder / "curves.csv", makeCurvesCsv(run));
  }
  if (!run.evaluation.posteriors.empty()) {
    writeTextFile(folder / "posterior.csv", makePosteriorCsv(run));
  }
  if (run.evaluation.calibration) {
    writeTextFile(folder / "sbc.csv", makeSbcCsv(run));
  }
  if (!run.evaluation.baselines.empty()) {
    writeTextFile(folder / "baselines.csv", makeBaselinesCsv(run));
  }
  if (!run.evaluation.maps.empty()) {
    writeTextFile(folder / "maps.csv", makeMapsCsv(run));
  }
  if (!run.evaluation.methods.empty()) {
    writeTextFile(folder / "methods.csv", makeMethodsCsv(run));
    writeTextFile(folder / "refined.csv", makeRefinedCsv(run));
  }
}

}  // namespace

void writeResults(const fs::path& folder, const RunSummary& run) {
  writeEvaluation(folder, run);
  writeTextFile(folder / "metrics.csv", makeMetricsCsv(run));
  writeTextFile(folder / "joint.csv", makeJointCsv(run));
  writeTextFile(folder / "pit.csv", makePitCsv(run));
  writeTextFile(folder / "predictions.csv", makePredictionsCsv(run));
  if (!run.evaluation.predictions.mixtures.empty()) {
    writeTextFile(folder / "components.csv", makeComponentsCsv(run));
  }
  writeTextFile(folder / "training.csv", makeTrainingCsv(run));
  writeTextFile(folder / "hyperparameters.csv", makeHyperparametersCsv(run));
  if (run.training.cross_validation) {
    writeTextFile(folder / "cross_validation.csv", makeCrossValidationCsv(run));
  }
  if (run.training.chains) {
    writeTextFile(folder / "chains.csv", makeChainsCsv(*run.training.chains));
  }
  writeTextFile(folder / "table.md", makeMarkdownTable(run));
  writeTextFile(folder / "table.tex", makeLatexTable(run));
}

void writeProvenance(const fs::path& folder, Provenance provenance, const RunSummary& run) {
  provenance.failed_samples = static_cast<int>(run.failures.size());
  provenance.reused_samples = run.reused_samples;
  provenance.online_updates = run.online.updates;
  provenance.online_median_us = run.online.median_us;
  provenance.online_p99_us = run.online.p99_us;
  provenance.warnings = collectWarnings(run);
  for (const StageTime& time : run.notes.times) {
    provenance.stage_seconds.emplace_back(time.stage, time.seconds);
  }
  provenance.digests = calcDigests(folder);
  writeTextFile(folder / "provenance.json", makeProvenanceJson(provenance));
}

}  // namespace twinmap
