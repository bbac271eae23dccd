#pragma once

#include <string>

#include "framework/results/run_summary.hpp"

namespace twinmap {

/// features.csv: feature, unit, output time, noise_stddev, then for each parameter the root mean square over
/// the test set of the feature's change per width of the bounds, in standard deviations of its noise.
std::string makeFeaturesCsv(const RunSummary& run);

/// correlations.csv: parameter, then a column for each parameter.
std::string makeCorrelationsCsv(const RunSummary& run);

/// identifiability.csv: an eigenvalue of the mean Fisher information a row, ascending, then the entries of
/// its eigenvector, a column for each parameter.
std::string makeIdentifiabilityCsv(const RunSummary& run);

/// identified.csv: of parameters that are not determined one by one a row for each combination that is, with
/// what to name it below `derived`; columns parameters (separated by spaces), undetermined (how many stay
/// so), name, expression, unit, residual (Combination::residual).
std::string makeIdentifiedCsv(const RunSummary& run);

/// posterior.csv: sample, parameter, posterior_mean, posterior_stddev, map_mean, map_stddev, limit_stddev,
/// effective_sample_size, simulations.
std::string makePosteriorCsv(const RunSummary& run);

/// sbc.csv: quantity (a parameter, or "joint"), bin, lower, upper (of the ranks' share), count, expected,
/// measurements, unreliable, chi_square, p_value.
std::string makeSbcCsv(const RunSummary& run);

/// baselines.csv: method, samples, parameter, bias_pct, sd_pct, mare_pct, coverage50, coverage90, coverage95,
/// seconds_per_update, unconverged.
std::string makeBaselinesCsv(const RunSummary& run);

/// maps.csv: map, parameter, bias_pct, sd_pct, mare_pct, limit_pct, ratio_to_limit, coverage50, coverage90,
/// coverage95, nlpd, joint_coverage95, joint_nlpd, training_seconds, online_us (median of one measurement),
/// bytes.
std::string makeMapsCsv(const RunSummary& run);

/// methods.csv: method, parameter, bias_pct, sd_pct, mare_pct, limit_pct, ratio_to_limit, coverage50,
/// coverage90, coverage95, samples, accepted (share), median_simulations; figures are those of the accepted
/// samples, the limit too.
std::string makeMethodsCsv(const RunSummary& run);

/// refined.csv: sample, status, start, chi_square, distance, iterations, simulations, message, answer,
/// statuses; then for each parameter NAME_true, NAME_refined, NAME_stddev, the last two only where it is
/// accepted.
std::string makeRefinedCsv(const RunSummary& run);

}  // namespace twinmap
