#include "framework/data/features/peaks.hpp"

#include <algorithm>
#include <cmath>

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// The lowest value between `top` and the next higher one in a direction, or the end.
double calcBase(const VectorXd& values, Index top, Index direction) {
  double base = values[top];
  for (Index i = top + direction; i >= 0 && i < values.size() && values[i] <= values[top]; i += direction) {
    base = std::min(base, values[i]);
  }
  return base;
}

/// Of equal neighbours the first counts.
bool isTop(const VectorXd& values, Index i) {
  Index next = i + 1;
  while (next < values.size() && values[next] == values[i]) {
    ++next;
  }
  return values[i] > values[i - 1] && next < values.size() && values[i] > values[next];
}

/// Least squares on k = -half .. half: c0 + c1 k + c2 k^2.
Peak fitParabola(const VectorXd& values, Index top, Index half) {
  double sum = 0.0, first = 0.0, second = 0.0, squares = 0.0, fourths = 0.0;
  for (Index i = -half; i <= half; ++i) {
    const auto k = static_cast<double>(i);
    sum += values[top + i];
    first += k * values[top + i];
    second += k * k * values[top + i];
    squares += k * k;
    fourths += k * k * k * k;
  }
  const double n = 2.0 * static_cast<double>(half) + 1.0;
  const double c2 = (n * second - squares * sum) / (n * fourths - squares * squares);
  const double c1 = first / squares, c0 = (sum - c2 * squares) / n;
  const double shift = -0.5 * c1 / c2;
  if (!(c2 < 0.0) || std::abs(shift) > static_cast<double>(half)) {
    return {static_cast<double>(top), values[top]};  // no top near the largest value: noise
  }
  return {static_cast<double>(top) + shift, c0 + 0.5 * c1 * shift};
}

}  // namespace

std::vector<Peak> findPeaks(const VectorXd& values, double prominence, int fit_samples, int most) {
  std::vector<Peak> peaks;
  if (!values.allFinite()) {
    return peaks;
  }
  const Index half = fit_samples / 2;
  for (Index i = half; i + half < values.size() && static_cast<int>(peaks.size()) < most; ++i) {
    if (isTop(values, i) &&
        values[i] - std::max(calcBase(values, i, -1), calcBase(values, i, 1)) >= prominence) {
      peaks.push_back(fitParabola(values, i, half));
    }
  }
  return peaks;
}

}  // namespace twinmap
