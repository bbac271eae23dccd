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

/// posterior.csv: sample, parameter, posterior_mean, posterior_stddev, map_mean, map_stddev, limit_stddev,
/// effective_sample_size, simulations.
std::string makePosteriorCsv(const RunSummary& run);

/// baselines.csv: method, samples, parameter, bias_pct, sd_pct, mare_pct, coverage50, coverage90, coverage95,
/// seconds_per_update, unconverged.
std::string makeBaselinesCsv(const RunSummary& run);

}  // namespace twinmap
