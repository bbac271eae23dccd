#pragma once

#include <vector>

namespace twinmap {

/// The cubic spline with continuous second derivative through points, not-a-knot at both ends (the two
/// outermost intervals share a polynomial; de Boor, A Practical Guide to Splines, IV): fourth order up to the
/// ends. Of three points the parabola, of two the line. Immutable.
class CubicSpline {
 public:
  /// `times` (s): strictly increasing, two or more, as many as values. Cost: O(n).
  CubicSpline(const std::vector<double>& times, const std::vector<double>& values);

  /// The value `elapsed` (s) after the first time; outside the points the outermost polynomials go on. Cost:
  /// that of one polynomial, for times that are equidistant or nearly so.
  double calc(double elapsed) const;

  double calcSlope(double elapsed) const;
  double calcCurvature(double elapsed) const;  ///< the second derivative

  struct Segment {
    double begin;                           ///< s after the first time
    double value, slope, curvature, third;  ///< of powers of the time since begin
  };
  const std::vector<Segment>& getSegments() const { return segments_; }

 private:
  std::size_t findSegment(double elapsed) const;

  std::vector<Segment> segments_;
  std::vector<std::size_t> first_guess_;  ///< the segment at the begin of each of equally long buckets
  double buckets_per_second_ = 0.0;
};

}  // namespace twinmap
