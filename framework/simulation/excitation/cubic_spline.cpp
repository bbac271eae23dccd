#include "framework/simulation/excitation/cubic_spline.hpp"

#include <algorithm>

namespace twinmap {
namespace {

using Vector = std::vector<double>;

/// Solves lower[i] x[i-1] + diagonal[i] x[i] + upper[i] x[i+1] = right[i] by elimination.
struct Tridiagonal {
  Vector lower, diagonal, upper, right;

  explicit Tridiagonal(std::size_t n) : lower(n), diagonal(n), upper(n), right(n) {}

  Vector solve() {
    const std::size_t n = diagonal.size();
    for (std::size_t i = 1; i < n; ++i) {
      const double factor = lower[i] / diagonal[i - 1];
      diagonal[i] -= factor * upper[i - 1];
      right[i] -= factor * right[i - 1];
    }
    right[n - 1] /= diagonal[n - 1];
    for (std::size_t i = n - 1; i-- > 0;) {
      right[i] = (right[i] - upper[i] * right[i + 1]) / diagonal[i];
    }
    return right;
  }
};

/// Slopes at the points from lengths h and secants d of the intervals: continuity of the second derivative
/// within, and of the third at the second and the last but one point.
Vector calcSlopes(const Vector& h, const Vector& d) {
  const std::size_t last = h.size();
  Tridiagonal system(last + 1);
  for (std::size_t i = 1; i < last; ++i) {
    system.lower[i] = h[i];
    system.diagonal[i] = 2.0 * (h[i - 1] + h[i]);
    system.upper[i] = h[i - 1];
    system.right[i] = 3.0 * (h[i] * d[i - 1] + h[i - 1] * d[i]);
  }
  const double begin = h[0] + h[1], end = h[last - 2] + h[last - 1];
  system.diagonal[0] = h[1];
  system.upper[0] = begin;
  system.right[0] = ((h[0] + 2.0 * begin) * h[1] * d[0] + h[0] * h[0] * d[1]) / begin;
  system.lower[last] = end;
  system.diagonal[last] = h[last - 2];
  system.right[last] =
      (h[last - 1] * h[last - 1] * d[last - 2] + (2.0 * end + h[last - 1]) * h[last - 2] * d[last - 1]) / end;
  return system.solve();
}

/// Slopes of the parabola through three points.
Vector calcParabolaSlopes(const Vector& h, const Vector& d) {
  const double curvature = (d[1] - d[0]) / (h[0] + h[1]);
  return {d[0] - curvature * h[0], d[0] + curvature * h[0], d[1] + curvature * h[1]};
}

}  // namespace

CubicSpline::CubicSpline(const Vector& times, const Vector& values) {
  const std::size_t intervals = times.size() - 1;
  Vector h(intervals), d(intervals);
  for (std::size_t i = 0; i < intervals; ++i) {
    h[i] = times[i + 1] - times[i];
    d[i] = (values[i + 1] - values[i]) / h[i];
  }
  const Vector slopes = intervals == 1   ? Vector{d[0], d[0]}
                        : intervals == 2 ? calcParabolaSlopes(h, d)
                                         : calcSlopes(h, d);
  for (std::size_t i = 0; i < intervals; ++i) {
    const double bend = (slopes[i] + slopes[i + 1] - 2.0 * d[i]) / h[i];
    segments_.push_back(
        {times[i] - times[0], values[i], slopes[i], (d[i] - slopes[i]) / h[i] - bend, bend / h[i]});
  }
  buckets_per_second_ = static_cast<double>(intervals) / (times.back() - times.front());
  std::size_t segment = 0;
  for (std::size_t bucket = 0; bucket < intervals; ++bucket) {
    const double begin = static_cast<double>(bucket) / buckets_per_second_;
    while (segment + 1 < intervals && segments_[segment + 1].begin <= begin) {
      ++segment;
    }
    first_guess_.push_back(segment);
  }
}

std::size_t CubicSpline::findSegment(double elapsed) const {
  const double bucket = std::clamp(elapsed * buckets_per_second_, 0.0, double(segments_.size() - 1));
  std::size_t segment = first_guess_[static_cast<std::size_t>(bucket)];
  while (segment + 1 < segments_.size() && segments_[segment + 1].begin <= elapsed) {
    ++segment;
  }
  return segment;
}

double CubicSpline::calc(double elapsed) const {
  const Segment& segment = segments_[findSegment(elapsed)];
  const double s = elapsed - segment.begin;
  return segment.value + s * (segment.slope + s * (segment.curvature + s * segment.third));
}

double CubicSpline::calcSlope(double elapsed) const {
  const Segment& segment = segments_[findSegment(elapsed)];
  const double s = elapsed - segment.begin;
  return segment.slope + s * (2.0 * segment.curvature + 3.0 * s * segment.third);
}

double CubicSpline::calcCurvature(double elapsed) const {
  const Segment& segment = segments_[findSegment(elapsed)];
  return 2.0 * segment.curvature + 6.0 * (elapsed - segment.begin) * segment.third;
}

}  // namespace twinmap
