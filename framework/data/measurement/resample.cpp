#include <algorithm>
#include <cmath>

#include "framework/base/text/number_text.hpp"
#include "framework/data/measurement/lagrange.hpp"
#include "framework/data/measurement/measurement.hpp"
#include "framework/data/measurement/time_series.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr int kPoints = InterpolationWeights::kPoints;

/// What to do where the file and the window have no time in common.
constexpr const char* kElsewhere =
    "; give the time in the file that is the model's 0 (--start), or the unit of its times, as 't [ms]'";

double calcSmallestDifference(const VectorXd& times) {
  return times.size() < 2 ? HUGE_VAL
                          : (times.tail(times.size() - 1) - times.head(times.size() - 1)).minCoeff();
}

class Interpolation {
 public:
  Interpolation(const Measurement& measurement, const VectorXd& needed, double interval)
      : source_(measurement.source), times_(measurement.times), interval_(interval) {
    if (times_.size() < 2) {
      fail("has " + std::to_string(times_.size()) + " samples; must have at least 2");
    }
    step_ = calcMedianStep(times_);
    requireCovered(needed[0], needed[needed.size() - 1]);
    for (const double t : needed) {
      stencils_.push_back(make(t));
    }
  }

  const InterpolationWeights& operator[](Index i) const { return stencils_[static_cast<std::size_t>(i)]; }

 private:
  double getTolerance() const { return kSameTime * step_; }

  void requireCovered(double from, double to) const {
    if (times_[0] > from + getTolerance()) {
      fail("begins at " + describeTime(times_[0]) + ", but is needed from " + describeTime(from) + " on" +
           (times_[0] > to ? kElsewhere : ""));
    }
    const double end = times_[times_.size() - 1];
    if (end < to - getTolerance()) {
      fail("ends at " + describeTime(end) + ", but is needed until " + describeTime(to) +
           (end < from ? kElsewhere : ""));
    }
  }

  InterpolationWeights make(double t) const {
    const double* begin = times_.data();
    const Index next = std::lower_bound(begin, begin + times_.size(), t - getTolerance()) - begin;
    if (std::abs(times_[next] - t) <= getTolerance()) {
      InterpolationWeights same;
      same.first = next;
      return same;
    }
    requireRate();
    const Index first = std::clamp<Index>(next - kPoints / 2, 0, times_.size() - kPoints);
    requireNoGap(first);
    return makeLagrange(times_, first, kPoints, t);
  }

  void requireRate() const {
    constexpr double kSlack = 1.01;
    if (times_.size() < kPoints || step_ > kSlack * interval_) {
      fail("has a sample each " + describeTime(step_) + " (median); at least one each " +
           describeTime(interval_) + " is needed");
    }
  }

  void requireNoGap(Index first) const {
    constexpr double kLongest = 1.5;
    for (Index i = first; i + 1 < first + kPoints; ++i) {
      if (times_[i + 1] - times_[i] > kLongest * step_) {
        fail("has a gap of " + describeTime(times_[i + 1] - times_[i]) +
             " after t = " + describeTime(times_[i]) + ", where samples are needed; the median step is " +
             describeTime(step_));
      }
    }
  }

  [[noreturn]] void fail(const std::string& problem) const {
    throw MeasurementError(source_ + ": " + problem);
  }

  const std::string& source_;
  const VectorXd& times_;
  double step_ = 0.0, interval_ = 0.0;
  std::vector<InterpolationWeights> stencils_;
};

void requireAlive(const Measurement& measurement, Index output, const RowRange& range) {
  constexpr Index kMin = 4;
  const auto values = measurement.values.col(output).segment(range.first, range.count);
  if (range.count >= kMin && (values.array() == values[0]).all()) {
    throw MeasurementError(
        measurement.source + ": column '" + measurement.column_names[output] + "' is " + toText(values[0]) +
        " (constant signal) from " + describeTime(measurement.times[range.first]) + " to " +
        describeTime(measurement.times[range.first + range.count - 1]) + "; check the sensor and its cable");
  }
}

}  // namespace

VectorXd resample(const Measurement& measurement, const ResponseLayout& layout,
                  std::optional<double> interval) {
  if (layout.modes > 0) {
    throw MeasurementError(measurement.source + ": holds no modes, of which features are made");
  }
  const VectorXd& needed = layout.times;
  VectorXd response(layout.getRowCount());
  if (response.size() == 0) {
    return response;
  }
  const Interpolation stencils(measurement, needed, interval.value_or(calcSmallestDifference(needed)));
  const RowRange range = findRows(measurement.times, needed[0], needed[needed.size() - 1], 0);
  for (Index output = 0; output < layout.getOutputCount(); ++output) {
    requireAlive(measurement, output, range);
    for (Index i = 0; i < needed.size(); ++i) {
      response[layout.getRow(output, i)] = apply(stencils[i], measurement.values.col(output));
    }
  }
  return response;
}

}  // namespace twinmap
