#include "framework/data/measurement/available_response.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "framework/base/text/number_text.hpp"
#include "framework/data/measurement/lagrange.hpp"
#include "framework/data/measurement/measurement.hpp"
#include "framework/data/measurement/time_series.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

std::string describeTime(double t) {
  constexpr int kDigits = 6;
  return toShortText(t, kDigits) + " s";
}

/// Rows in the order of their times.
struct RowOrder {
  std::vector<Index> rows;
  std::vector<std::string> remarks;
};

RowOrder sortRows(const VectorXd& times) {
  RowOrder order;
  for (Index i = 0; i < times.size(); ++i) {
    if (std::isfinite(times[i])) {
      order.rows.push_back(i);
    }
  }
  if (const auto without = times.size() - static_cast<Index>(order.rows.size()); without > 0) {
    order.remarks.push_back(fmt::format("{} rows without a time", without));
  }
  const auto before = [&](Index a, Index b) { return times[a] < times[b]; };
  if (!std::is_sorted(order.rows.begin(), order.rows.end(), before)) {
    std::stable_sort(order.rows.begin(), order.rows.end(), before);
    order.remarks.emplace_back("rows are not in the order of their times: sorted");
  }
  const auto same = [&](Index a, Index b) { return times[a] == times[b]; };
  const auto end = std::unique(order.rows.begin(), order.rows.end(), same);
  if (const auto doubled = order.rows.end() - end; doubled > 0) {
    order.remarks.push_back(fmt::format("{} rows with the time of another: the first is taken", doubled));
  }
  order.rows.erase(end, order.rows.end());
  return order;
}

/// The table's rows in that order; columns of other lengths stay as they are, which is found later.
Table takeRows(const Table& table, Index count, const std::vector<Index>& rows) {
  Table taken = table;
  for (Column& column : taken.columns) {
    if (column.values.size() == count) {
      column.values = VectorXd(column.values(rows));
    }
  }
  return taken;
}

/// The samples of one column, those that are there.
struct Samples {
  VectorXd times, values;
};

Samples takeSamples(const VectorXd& times, const VectorXd& values) {
  std::vector<Index> there;
  for (Index i = 0; i < values.size(); ++i) {
    if (std::isfinite(values[i])) {
      there.push_back(i);
    }
  }
  return {times(there), values(there)};
}

/// A column's value at a needed time, or NaN.
class SampleFinder {
 public:
  SampleFinder(const Samples& samples, double interval) : samples_(samples) {
    constexpr double kSlack = 1.01;
    if (samples.times.size() > 1) {
      step_ = calcMedianStep(samples.times);
    }
    interpolates_ = samples.times.size() >= InterpolationWeights::kPoints && step_ <= kSlack * interval;
  }

  double find(double t) const {
    const VectorXd& times = samples_.times;
    const double tolerance = 1e-6 * step_;
    const double* begin = times.data();
    const Index next = std::lower_bound(begin, begin + times.size(), t - tolerance) - begin;
    if (next < times.size() && std::abs(times[next] - t) <= tolerance) {
      return samples_.values[next];
    }
    if (!interpolates_ || next == 0 || next == times.size()) {
      return kMissing;
    }
    constexpr int kPoints = InterpolationWeights::kPoints;
    const Index first = std::clamp<Index>(next - kPoints / 2, 0, times.size() - kPoints);
    return hasGap(first) ? kMissing : apply(makeLagrange(times, first, kPoints, t), samples_.values);
  }

 private:
  bool hasGap(Index first) const {
    constexpr double kLongest = 1.5;
    for (Index i = first; i + 1 < first + InterpolationWeights::kPoints; ++i) {
      if (samples_.times[i + 1] - samples_.times[i] > kLongest * step_) {
        return true;
      }
    }
    return false;
  }

  const Samples& samples_;
  double step_ = 0.0;
  bool interpolates_ = false;
};

/// "12 of 100 samples of x: 0.4 s to 0.48 s ...": where they are missing, the longest stretch.
std::string describeMissing(const std::string& column, const VectorXd& needed, const VectorXd& found) {
  Index missing = 0, run = 0, longest = 0, end_of_longest = 0;
  for (Index i = 0; i < found.size(); ++i) {
    run = std::isfinite(found[i]) ? 0 : run + 1;
    missing += run > 0 ? 1 : 0;
    if (run > longest) {
      longest = run;
      end_of_longest = i;
    }
  }
  std::string text = fmt::format("{} of {} samples of {}", missing, found.size(), column);
  if (longest > 1) {
    text +=
        fmt::format(", the longest gap {} at {} to {}", longest,
                    describeTime(needed[end_of_longest - longest + 1]), describeTime(needed[end_of_longest]));
  }
  return text;
}

void requireUsable(const Table& table, const std::string& column, const VectorXd& needed,
                   const VectorXd& found) {
  constexpr Index kMin = 4;
  const Samples there = takeSamples(needed, found);
  if (there.values.size() == 0) {
    throw MeasurementError(fmt::format(
        "{}: column '{}' has no sample at any needed time, {} to {}; give the time in the file that is the "
        "model's 0 (--start), or the unit of its times, as 't [ms]'",
        table.source, column, describeTime(needed[0]), describeTime(needed[needed.size() - 1])));
  }
  if (there.values.size() >= kMin && (there.values.array() == there.values[0]).all()) {
    throw MeasurementError(table.source + ": column '" + column + "' is " + toText(there.values[0]) +
                           " at all needed times, " + describeTime(there.times[0]) + " to " +
                           describeTime(there.times[there.times.size() - 1]) +
                           " (constant signal); check the sensor and its cable");
  }
}

double calcSmallestStep(const VectorXd& times) {
  return times.size() < 2 ? HUGE_VAL
                          : (times.tail(times.size() - 1) - times.head(times.size() - 1)).minCoeff();
}

}  // namespace

AvailableResponse readAvailable(const Table& table, const MeasurementSpec& spec, const ResponseLayout& layout,
                                std::optional<double> interval) {
  if (layout.modes > 0) {
    throw MeasurementError(table.source + ": holds no modes, of which features are made");
  }
  AvailableResponse available{VectorXd::Constant(layout.getRowCount(), kMissing), 0, {}};
  if (layout.getRowCount() == 0) {
    return available;
  }
  const std::string& first = findColumnSpec(spec, layout.output_names.front()).name;
  const Index rows = getColumn(table, first).values.size();
  const TimeBase base{spec.time, spec.sample_rate, spec.start};
  RowOrder order = sortRows(readUnorderedTimes(table, base, rows));
  available.remarks = std::move(order.remarks);
  const Table sorted = takeRows(table, rows, order.rows);
  const VectorXd times = readUnorderedTimes(sorted, base, static_cast<Index>(order.rows.size()));
  const VectorXd& needed = layout.times;
  const double spacing = interval.value_or(calcSmallestStep(needed));
  for (Index output = 0; output < layout.getOutputCount(); ++output) {
    const auto o = static_cast<std::size_t>(output);
    const ColumnSpec column = findColumnSpec(spec, layout.output_names[o]);
    requireLength(sorted, getColumn(sorted, column.name), times.size());
    const Samples samples =
        takeSamples(times, readValues(sorted, column, layout.output_units[o], 0, times.size()));
    const SampleFinder finder(samples, spacing);
    VectorXd found(needed.size());
    for (Index i = 0; i < needed.size(); ++i) {
      found[i] = finder.find(needed[i]);
      available.response[layout.getRow(output, i)] = found[i];
    }
    requireUsable(sorted, column.name, needed, found);
    if (found.hasNaN()) {
      available.remarks.push_back(describeMissing(column.name, needed, found));
      available.missing += found.array().isNaN().count();
    }
  }
  return available;
}

}  // namespace twinmap
