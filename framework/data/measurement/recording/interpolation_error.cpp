#include "framework/data/measurement/recording/interpolation_error.hpp"

#include <algorithm>
#include <cmath>

#include "framework/data/measurement/time_series.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

constexpr Index kFew = 4, kMany = 6;

/// Lagrange's weights of `count` samples from `first` on.
VectorXd makeWeights(const VectorXd& times, Index first, Index count, double t) {
  VectorXd weights = VectorXd::Ones(count);
  for (Index i = 0; i < count; ++i) {
    for (Index j = 0; j < count; ++j) {
      if (i != j) {
        weights[i] *= (t - times[first + j]) / (times[first + i] - times[first + j]);
      }
    }
  }
  return weights;
}

/// The weights of the six nearest samples less those of the four.
VectorXd calcDifference(const VectorXd& times, Index first, double t) {
  VectorXd difference = makeWeights(times, first, kMany, t);
  difference.segment((kMany - kFew) / 2, kFew) -= makeWeights(times, first + (kMany - kFew) / 2, kFew, t);
  return difference;
}

/// Whether samples about a needed time are lost, so that nothing is interpolated there.
bool hasGap(const VectorXd& times, Index first, double step) {
  constexpr double kLongest = 1.5;
  const VectorXd steps = times.segment(first + 1, kMany - 1) - times.segment(first, kMany - 1);
  return steps.maxCoeff() > kLongest * step;
}

}  // namespace

double calcInterpolationError(const VectorXd& times, const VectorXd& values,
                              const std::vector<double>& needed, double stddev) {
  if (times.size() < kMany || needed.empty()) {
    return 0.0;
  }
  const double step = calcMedianStep(times), tolerance = kSameTime * step;
  double squares = 0.0;
  Index left_out = 0;
  for (const double t : needed) {
    const Index next = std::lower_bound(times.begin(), times.end(), t - tolerance) - times.begin();
    const Index first = next - kMany / 2;
    if (next >= times.size() || std::abs(times[next] - t) <= tolerance || first < 0 ||
        first + kMany > times.size()) {
      continue;
    }
    if (hasGap(times, first, step)) {
      ++left_out;
      continue;
    }
    const VectorXd difference = calcDifference(times, first, t);
    const double error = difference.dot(values.segment(first, kMany));
    squares += error * error - stddev * stddev * difference.squaredNorm();
  }
  const Index counted = static_cast<Index>(needed.size()) - left_out;
  return counted == 0 ? 0.0 : std::sqrt(std::max(0.0, squares / static_cast<double>(counted)));
}

}  // namespace twinmap
