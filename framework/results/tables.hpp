#pragma once

#include <string>

#include "framework/results/run_summary.hpp"

namespace twinmap {

/// metrics.csv: one row a parameter, then one a derived quantity; columns parameter, unit, lower, upper,
/// kFigureColumns (limit_pct and ratio_to_limit only where the limit is known), loo_sd_pct, loo_coverage95,
/// loo_nlpd (empty where not available), nlml, test_samples, then the standard error of each figure as
/// NAME_se, and not_ok where answers were refined (AnswerSummary).
std::string makeMetricsCsv(const RunSummary& run);

/// joint.csv: metric, value, se; one row each of kJointColumns.
std::string makeJointCsv(const RunSummary& run);

/// pit.csv: parameter, bin_lower, bin_upper, count.
std::string makePitCsv(const RunSummary& run);

/// components.csv: of predictions that are mixtures; docs/reference/files.md.
std::string makeComponentsCsv(const RunSummary& run);

/// predictions.csv: sample, parameter, true, inferred, stddev, limit_stddev where the limit is known,
/// interval_factor50 and interval_factor95 where intervals are not those of normal distributions, stands_for
/// where samples stand for others (Estimates::weights); all parameters of a sample, then the next.
std::string makePredictionsCsv(const RunSummary& run);

/// derived.csv: sample, parameter (a derived quantity), true, inferred, stddev, lower, upper (of 95 %),
/// limit_stddev where the limit is known. Needs Evaluation::derived.
std::string makeDerivedCsv(const RunSummary& run);

/// curves.csv: sample, curve, argument, true, inferred, lower, upper (of 95 %). Needs Evaluation::curves.
std::string makeCurvesCsv(const RunSummary& run);

/// failures.csv: set, sample, the value of each parameter of the sampled box, reason.
std::string makeFailuresCsv(const std::vector<ParameterSpec>& sampled,
                            const std::vector<FailedSample>& failures);

/// training.csv: parameter, start, best, nlml, evaluations, noise_only, stop_reason; of the best start also
/// at_bound, condition, jitter.
std::string makeTrainingCsv(const RunSummary& run);

/// cross_validation.csv: parameter, coverage95, stddev_scale, log_density, status, limit_ratio, halved_to,
/// error_ratio, interval_factor50, interval_factor95.
std::string makeCrossValidationCsv(const RunSummary& run);

/// chains.csv: quantity, r_hat, effective_draws; the same in each row: weights, chains, draws, divergences,
/// cut, acceptance.
std::string makeChainsCsv(const SampledChains& sampled);

/// hyperparameters.csv: parameter, hyperparameter, value, lower, upper; of the start that was kept.
std::string makeHyperparametersCsv(const RunSummary& run);

/// The paper's table, human-readable: Markdown (columns aligned, so that it reads well as plain text) and
/// LaTeX (booktabs). Bias, sd, coverage and ratio carry their standard error in parentheses
/// (number_with_error.hpp); the information limit and the ratio to it have columns where the limit is known.
/// With them the Markdown table of the two-beam case fills 120 columns.
std::string makeMarkdownTable(const RunSummary& run);
std::string makeLatexTable(const RunSummary& run);

}  // namespace twinmap
