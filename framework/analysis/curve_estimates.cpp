#include "framework/analysis/curve_estimates.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "framework/base/text/number_text.hpp"

namespace twinmap {
namespace {

/// More than a smooth curve of 50 knots bends.
constexpr int kPoints = 41;

bool canBeDerived(ExperimentSpec experiment, const DerivedSpec& point) {
  experiment.derived = {point};
  try {
    return DerivedQuantities(experiment).count() == 1;
  } catch (const ExperimentError&) {
    return false;  // its values use other than updating parameters, so that nothing is estimated of them
  }
}

}  // namespace

CurveEstimates estimateCurves(const ExperimentSpec& experiment, const Eigen::MatrixXd& truth,
                              const Estimates& estimates) {
  CurveEstimates result;
  ExperimentSpec points = experiment;
  points.derived.clear();
  for (const CurveSpec& curve : experiment.model.system.curves) {
    for (int i = 0; i < kPoints; ++i) {
      const double share = static_cast<double>(i) / (kPoints - 1);
      const double argument = (1.0 - share) * curve.range.lower + share * curve.range.upper;
      const std::string text = fmt::format("{}({})", curve.name.text, toText(argument));
      const DerivedSpec point{{text, curve.name.where}, {text, curve.name.where}, curve.unit, ""};
      if (i == 0 && !canBeDerived(experiment, point)) {
        break;
      }
      points.derived.push_back(point);
      result.curves.push_back(curve.name.text);
      result.arguments.push_back(argument);
    }
  }
  if (!points.derived.empty()) {
    const Eigen::Index drawn = std::min(kDrawnCurves, truth.cols());
    Estimates each = estimates;
    each.repeated.clear();
    each.weights.resize(0);
    result.values = evaluateDerived(DerivedQuantities(points), truth.leftCols(drawn), each, {});
  }
  return result;
}

}  // namespace twinmap
