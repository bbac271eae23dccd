#pragma once

#include <string>

#include "framework/report/run_summary.hpp"

namespace twinmap {

/// metrics.csv: one row a parameter; columns parameter, unit, lower, upper, bias_pct, sd_pct, mare_pct,
/// coverage95, then coverage90, coverage50, stddev_pct, z_mean, z_sd, nlpd, nlml, test_samples.
std::string makeMetricsCsv(const RunSummary& run);

/// predictions.csv: sample, parameter, true, inferred, stddev; all parameters of a sample, then the next.
std::string makePredictionsCsv(const RunSummary& run);

/// failures.csv: set, sample, each parameter's value, reason.
std::string makeFailuresCsv(const RunSummary& run);

/// training.csv: parameter, start, best, nlml, evaluations, noise_only, stop_reason; of the best start also
/// at_bound, condition, jitter.
std::string makeTrainingCsv(const RunSummary& run);

/// The paper's table for people: Markdown (columns aligned, so that it reads well as plain text) and LaTeX
/// (booktabs).
std::string makeMarkdownTable(const RunSummary& run);
std::string makeLatexTable(const RunSummary& run);

}  // namespace twinmap
