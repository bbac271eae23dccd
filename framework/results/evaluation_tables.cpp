#include "framework/results/evaluation_tables.hpp"

#include <algorithm>
#include <cmath>

#include "framework/base/text/csv.hpp"
#include "framework/base/text/number_text.hpp"

namespace twinmap {
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

}  // namespace

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

std::string makeCorrelationsCsv(const RunSummary& run) {
  std::vector<CsvRow> rows{addParameterNames({"parameter"}, run)};
  for (std::size_t p = 0; p < run.parameters.size(); ++p) {
    rows.push_back(addNumbers({run.parameters[p].name.text},
                              run.evaluation.identifiability->correlation.row(static_cast<Index>(p))));
  }
  return makeCsv(rows);
}

std::string makeIdentifiabilityCsv(const RunSummary& run) {
  std::vector<CsvRow> rows{addParameterNames({"eigenvalue"}, run)};
  const Identifiability& found = *run.evaluation.identifiability;
  for (Index k = 0; k < found.eigenvalues.size(); ++k) {
    rows.push_back(addNumbers({toText(found.eigenvalues[k])}, found.eigenvectors.col(k)));
  }
  return makeCsv(rows);
}

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

}  // namespace twinmap
