#include "framework/report/sections/warnings.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "framework/report/sections/samples_table.hpp"
#include "framework/spec/parameter_box.hpp"
#include "framework/spec/yaml/number_text.hpp"

namespace twinmap {
namespace {

constexpr int kDigits = 3;

void appendRecorded(const RunFolder& run, std::vector<std::string>& warnings) {
  warnings.insert(warnings.end(), run.provenance.warnings.begin(), run.provenance.warnings.end());
}

/// Whether the run itself warned about the parameter.
bool isRecorded(const RunFolder& run, const std::string& parameter) {
  std::vector<std::string> recorded;
  appendRecorded(run, recorded);
  const auto names_it = [&](const std::string& warning) {
    return warning.find("'" + parameter + "'") != std::string::npos;
  };
  return std::any_of(recorded.begin(), recorded.end(), names_it);
}

/// 95 % intervals that hold too few or too many true values: further from 0.95 than three standard errors.
void appendCoverage(const RunFolder& run, std::vector<std::string>& warnings) {
  constexpr double kNominal = 0.95, kErrors = 3.0;
  for (std::size_t row = 0; row < run.metrics.rows.size(); ++row) {
    const double coverage = run.metrics.getNumber(row, "coverage95");
    const double samples = run.metrics.getNumber(row, "test_samples");
    const double standard_error = std::sqrt(kNominal * (1.0 - kNominal) / samples);
    if (!(std::abs(coverage - kNominal) > kErrors * standard_error)) {
      continue;
    }
    const std::string what = "The 95 % intervals of " + run.metrics.getText(row, "parameter") + " hold " +
                             toShortText(coverage, kDigits) + " of the true values: they are too ";
    warnings.push_back(what + (coverage < kNominal
                                   ? "narrow. More training samples, more noise.replicates or fewer inputs "
                                     "(principal_components) make them honest."
                                   : "wide. More training samples make them narrower."));
  }
}

void appendLimit(const RunFolder& run, std::vector<std::string>& warnings) {
  constexpr double kFar = 1.5;
  for (std::size_t row = 0; row < run.metrics.rows.size(); ++row) {
    const double ratio = run.metrics.getNumber(row, "ratio_to_limit");
    if (ratio > kFar) {
      warnings.push_back(
          "The data determine " + run.metrics.getText(row, "parameter") + " " + toShortText(ratio, 2) +
          " times better than this map does. More training samples or other features come closer "
          "to the limit.");
    }
  }
}

/// Inferred standard deviations close to that of the box: nothing was learnt.
void appendUninformed(const RunFolder& run, std::vector<std::string>& warnings) {
  constexpr double kUninformed = 0.7;
  for (const ParameterSpec& parameter : run.experiment.model.parameters) {
    const ParameterPredictions found = collectPredictions(run.predictions, parameter.name.text);
    double sum = 0.0;
    for (const double stddev : found.stddev) {
      sum += stddev * stddev;
    }
    const double box_stddev = kUniformStddev * (parameter.bounds.upper - parameter.bounds.lower);
    const bool is_uninformed =
        std::sqrt(sum / static_cast<double>(found.stddev.size())) > kUninformed * box_stddev;
    if (is_uninformed && !isRecorded(run, parameter.name.text)) {
      warnings.push_back("The response says little about " + parameter.name.text +
                         ": its inferred sd is close to that of its bounds. Measure another output, excite "
                         "differently, or do not infer it.");
    }
  }
}

void appendCorrelations(const RunFolder& run, std::vector<std::string>& warnings) {
  constexpr double kInseparable = 0.95;
  const CsvTable& table = run.correlations;
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    for (std::size_t other = 0; other < row; ++other) {
      const std::string& name = table.getText(row, "parameter");
      const std::string& other_name = table.getText(other, "parameter");
      const double correlation = table.getNumber(row, other_name);
      if (std::abs(correlation) > kInseparable && !isRecorded(run, name) && !isRecorded(run, other_name)) {
        warnings.push_back("The response hardly tells " + other_name + " from " + name + " (correlation " +
                           toShortText(correlation, kDigits) +
                           "): only a combination of them is determined. Measure another output or excite "
                           "differently.");
      }
    }
  }
}

void appendFailures(const RunFolder& run, std::vector<std::string>& warnings) {
  const std::size_t failed = run.failures.rows.size();
  if (failed > 0) {
    warnings.push_back(fmt::format(
        "{} {} could not be simulated, and the map was neither trained nor tested there: see Failures.",
        failed, failed == 1 ? "sample" : "samples"));
  }
}

/// Without the length scales at their upper bound: these merely say that an input is irrelevant.
std::string dropLongLengthScales(const std::string& at_bound) {
  std::string kept;
  std::istringstream items(at_bound);
  for (std::string item; std::getline(items, item, ';');) {
    item.erase(0, item.find_first_not_of(' '));
    const bool is_long = item.rfind("length_scale", 0) == 0 && item.find("upper bound") != std::string::npos;
    kept += is_long ? "" : (kept.empty() ? "" : "; ") + item;
  }
  return kept;
}

void appendTraining(const RunFolder& run, std::vector<std::string>& warnings) {
  for (std::size_t row = 0; row < run.training.rows.size(); ++row) {
    if (run.training.getText(row, "best") != "1") {
      continue;
    }
    const std::string& name = run.training.getText(row, "parameter");
    if (run.training.getText(row, "noise_only") == "1" && !isRecorded(run, name)) {
      warnings.push_back(
          "The map of " + name +
          " explains its parameter as noise alone. More inverse_map.gp.starts or other features "
          "may find a signal.");
    }
    const std::string at_bound = dropLongLengthScales(run.training.getText(row, "at_bound"));
    if (!at_bound.empty()) {
      warnings.push_back("Hyperparameters of " + name + " ended at a bound (" + at_bound +
                         "): widen inverse_map.gp.bounds.");
    }
  }
}

}  // namespace

std::vector<std::string> collectWarnings(const RunFolder& run) {
  std::vector<std::string> warnings;
  appendFailures(run, warnings);
  appendRecorded(run, warnings);
  appendCoverage(run, warnings);
  appendLimit(run, warnings);
  appendUninformed(run, warnings);
  appendCorrelations(run, warnings);
  appendTraining(run, warnings);
  return warnings;
}

}  // namespace twinmap
