#pragma once

#include <string>
#include <vector>

#include "framework/report/figure.hpp"
#include "framework/report/sections/sweep_groups.hpp"

namespace twinmap {

/// The table of groups that the figures of a sweep draw: variant, parameter, size, noise, seeds, sd_pct,
/// lowest, highest, limit_pct, coverage95.
inline constexpr const char* kSweepTable = "sweep";

/// What the sweep varied, and how its figures tell lines apart.
struct SweepAxes {
  std::vector<SweepGroup> groups;
  std::vector<std::string> parameters, variants;
  std::vector<double> sizes, noises;
  bool has_limits = false;
};

/// sd over the training size, or over the noise; logarithmic.
Figure makeCurveFigure(const SweepAxes& axes, bool over_size);
Figure makeHeatMapFigure(const SweepAxes& axes);
/// For sweeps over neither size nor noise: one row per variant.
Figure makeVariantFigure(const SweepAxes& axes);

}  // namespace twinmap
