#pragma once

#include "framework/report/data_table.hpp"
#include "framework/results/run_folder.hpp"

namespace twinmap {

/// Confidence of every band.
inline constexpr double kConfidence = 0.95;

/// parameter, sample, level, observed: the probability of the central interval that just contains the truth,
/// and the fraction of the samples whose interval is no wider. Samples without a finite z are left out.
DataTable makeReliabilityTable(const RunFolder& run);

/// level, lower, upper: how far the observed fraction of n samples strays from each level by chance.
DataTable makeReliabilityBand(int n);

/// How far each of `bins` counts of n samples strays from n / bins by chance.
struct CountBand {
  double lower = 0.0, upper = 0.0;
};
CountBand calcCountBand(int n, int bins);

/// parameter, sample, quantile, z, lower, upper: the normal quantile of the sample's rank among the z-scores,
/// its z, and the band in which a calibrated map's lies.
DataTable makeQuantileTable(const RunFolder& run);

}  // namespace twinmap
