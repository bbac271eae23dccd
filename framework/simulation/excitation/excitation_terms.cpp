#include "framework/simulation/excitation/excitation_terms.hpp"

#include "framework/simulation/excitation/cubic_spline.hpp"

namespace twinmap {

std::vector<double> calcSchroederPhases(int count) {
  std::vector<double> phases;
  for (int k = 1; k <= count; ++k) {
    phases.push_back(-0.5 * kRadiansPerCycle * k * (k - 1) / count);
  }
  return phases;
}

std::vector<TablePiece> calcTablePieces(const TableSpec& table) {
  std::vector<TablePiece> pieces;
  if (table.interpolation == TableInterpolation::kCubic) {
    const CubicSpline spline(table.times, table.values);
    for (std::size_t i = 0; i < spline.getSegments().size(); ++i) {
      const CubicSpline::Segment& segment = spline.getSegments()[i];
      pieces.push_back({table.times[i],
                        table.times[i + 1],
                        {segment.value, segment.slope, segment.curvature, segment.third}});
    }
    return pieces;
  }
  for (std::size_t i = 0; i + 1 < table.times.size(); ++i) {
    const double length = table.times[i + 1] - table.times[i];
    if (length > 0.0) {  // a time given twice is a jump
      const bool hold = table.interpolation == TableInterpolation::kHold;
      const double slope = hold ? 0.0 : (table.values[i + 1] - table.values[i]) / length;
      pieces.push_back({table.times[i], table.times[i + 1], {table.values[i], slope, 0.0, 0.0}});
    }
  }
  return pieces;
}

}  // namespace twinmap
