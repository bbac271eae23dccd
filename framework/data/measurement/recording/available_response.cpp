#include "framework/data/measurement/recording/available_response.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>

#include "framework/base/text/number_text.hpp"
#include "framework/data/measurement/files/read_table.hpp"
#include "framework/data/measurement/lagrange.hpp"
#include "framework/data/measurement/measured_modes.hpp"
#include "framework/data/measurement/measurement.hpp"
#include "framework/data/measurement/recording.hpp"
#include "framework/data/measurement/recording/recorded_times.hpp"
#include "framework/data/measurement/time_series.hpp"
#include "kernels/linalg/order.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

/// What a column says at a needed time.
struct FoundSample {
  double value = kMissing;
  double side = 0.0;  ///< of the range's limit where it is clipped
};

/// Finds a column's samples at needed times.
class SampleFinder {
 public:
  /// start: added to the times in the file, which may be seconds since 1970 and rounded accordingly.
  SampleFinder(const Samples& samples, double start, double interval, const std::optional<Bounds>& range)
      : samples_(samples), range_(range) {
    constexpr double kSlack = 1.01, kRounding = 4e-16;
    if (samples.times.size() > 1) {
      step_ = calcMedianStep(samples.times);
      tolerance_ = std::max(kSameTime * step_, kRounding * std::abs(start));
    }
    sparse_ = step_ > kSlack * interval;
    interpolates_ = samples.times.size() >= InterpolationWeights::kPoints && !sparse_;
  }

  const VectorXd& getTimes() const { return samples_.times; }

  /// Why nothing is interpolated; "" where it is.
  std::string describeSparse() const {
    return sparse_
               ? fmt::format("; its samples are {} apart, too far to be interpolated", describeTime(step_))
               : "";
  }

  FoundSample find(double t) const {
    const VectorXd& times = samples_.times;
    const double* begin = times.data();
    const Index next = std::lower_bound(begin, begin + times.size(), t - tolerance_) - begin;
    if (next < times.size() && std::abs(times[next] - t) <= tolerance_) {
      const double value = samples_.values[next], side = findSide(range_, value);
      return {side == 0.0 ? value : kMissing, side};
    }
    if (!interpolates_ || next == 0 || next == times.size()) {
      return {};
    }
    constexpr int kPoints = InterpolationWeights::kPoints;
    const Index first = std::clamp<Index>(next - kPoints / 2, 0, times.size() - kPoints);
    if (hasGap(first)) {
      return {};
    }
    if (isNearLimit(first)) {
      const double before = findSide(range_, samples_.values[next - 1]);
      return {kMissing, before == findSide(range_, samples_.values[next]) ? before : 0.0};
    }
    return {apply(makeLagrange(times, first, kPoints, t), samples_.values), 0.0};
  }

 private:
  bool isNearLimit(Index first) const {
    for (Index i = first; i < first + InterpolationWeights::kPoints; ++i) {
      if (findSide(range_, samples_.values[i]) != 0.0) {
        return true;
      }
    }
    return false;
  }

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
  const std::optional<Bounds> range_;
  double step_ = 0.0, tolerance_ = 0.0;
  bool interpolates_ = false, sparse_ = false;
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

/// Why none of a column's samples, which are there at `times`, can be used. clock: what is assumed of it
/// (describeAssumedUnit).
std::string describeUseless(const VectorXd& times, const VectorXd& needed, const std::string& clock) {
  const std::string assumed = clock.empty() ? "" : " (" + clock + ")",
                    unit = clock.empty() ? "" : ", or the unit of its times, as 't [ms]'" + assumed;
  if (times.size() == 0) {
    return "has no number in any row; check the sensor and its cable";
  }
  const std::string first = describeTime(times.minCoeff()), last = describeTime(times.maxCoeff());
  if (times.size() == 1) {
    return fmt::format("has a single time, {}, in all rows; name the column of times (measurement.time)",
                       first);
  }
  if (times.minCoeff() <= needed[needed.size() - 1] && times.maxCoeff() >= needed[0]) {
    return fmt::format(
        "has no sample at any needed time, {} to {}, but {} between them, {} apart (median), too far or too "
        "unevenly to be interpolated; give features an interval of at least that, or make all of them "
        "samples, which inference from the experiment file takes at the times of the recording{}",
        describeTime(needed[0]), describeTime(needed[needed.size() - 1]),
        (times.array() >= needed[0] && times.array() <= needed[needed.size() - 1]).count(),
        describeTime(calcMedianStep(times)), unit);
  }
  return fmt::format(
      "has no sample at any needed time, {} to {}, but some from {} to {}{}; give the time in the file that "
      "is the model's 0 (--start), or the unit of its times, as 't [ms]'",
      describeTime(needed[0]), describeTime(needed[needed.size() - 1]), first, last, assumed);
}

void requireUsable(const Table& table, const std::string& column, const VectorXd& times,
                   const VectorXd& needed, const VectorXd& found, const std::string& clock) {
  constexpr Index kMin = 4;
  const Samples there = takeSamples(needed, found);
  if (there.values.size() == 0) {
    throw MeasurementError(table.source + ": column '" + column + "' " +
                           describeUseless(times, needed, clock));
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

/// The times of a layout, by number, at which features need an output.
std::vector<Index> listNeeded(const VectorXd& times, const std::string& output,
                              const std::vector<FeatureSpec>& features) {
  const std::vector<Index> all = listIndices(times.size());
  std::vector<Index> needed;
  if (!features.empty() && !usesOutput(features, output)) {
    return {};
  }
  if (features.empty() || !areSamples(features)) {
    return all;
  }
  const std::vector<double> asked = collectTimesOf(output, features);
  const double same = times.size() > 1 ? kSameTime * calcMedianStep(times) : 0.0;
  std::copy_if(all.begin(), all.end(), std::back_inserter(needed), [&](Index i) {
    const auto next = std::lower_bound(asked.begin(), asked.end(), times[i] - same);
    return next != asked.end() && *next <= times[i] + same;
  });
  return needed;
}

/// Finds the samples of an output: in its rows of the response, missing only at these of the layout's times.
/// clock: what is assumed of its times.
void addOutput(const Table& table, const std::string& column, const SampleFinder& finder,
               const std::optional<Bounds>& range, const ResponseLayout& layout, Index output,
               const std::vector<Index>& at, const std::string& clock, AvailableResponse& available) {
  const VectorXd needed = layout.times(at);
  VectorXd found(layout.times.size()), known(found.size());
  std::vector<ClippedSample> beyond;
  for (Index i = 0; i < found.size(); ++i) {
    const FoundSample sample = finder.find(layout.times[i]);
    const Index row = layout.getRow(output, i);
    available.response[row] = found[i] = sample.value;
    known[i] = sample.side == 0.0 ? sample.value : 0.0;
    if (sample.side != 0.0 && std::binary_search(at.begin(), at.end(), i)) {
      beyond.push_back({row, sample.side > 0.0 ? range->upper : range->lower, sample.side});
    }
  }
  requireUsable(table, column, finder.getTimes(), needed, found(at), clock);
  available.clipped.insert(available.clipped.end(), beyond.begin(), beyond.end());
  known = VectorXd(known(at));
  if (!beyond.empty()) {
    available.remarks.push_back(
        fmt::format("{} of {} samples of {} are at a limit of its range: what they say is that the response "
                    "is there or beyond",
                    beyond.size(), needed.size(), column));
  }
  if (known.hasNaN()) {
    available.remarks.push_back(describeMissing(column, needed, known) + finder.describeSparse());
    available.missing += known.array().isNaN().count();
  }
}

/// Modes, in their rows of the response.
void addModes(const Table& table, const MeasurementSpec& spec, const ResponseLayout& layout,
              AvailableResponse& available) {
  if (!spec.modes && layout.times.size() > 0) {
    throw MeasurementError(table.source +
                           ": is a recording in time, but features are made of modes too; give the file of a "
                           "table of modes as measurement.modes");
  }
  const Table own = spec.modes
                        ? readTable(std::filesystem::path(table.source).parent_path() / spec.modes->text,
                                    listModeColumns(), MissingCells::kKeep)
                        : Table();
  const MeasuredModes modes = readModes(spec.modes ? own : table, layout);
  const auto frequencies = Eigen::seqN(layout.getFrequencyRow(0), layout.modes);
  const auto damping_ratios = Eigen::seqN(layout.getDampingRow(0), layout.modes);
  available.response(frequencies) = modes.frequencies;
  available.response(damping_ratios) = modes.damping_ratios;
  available.missing +=
      modes.frequencies.array().isNaN().count() + modes.damping_ratios.array().isNaN().count();
  available.remarks.insert(available.remarks.end(), modes.remarks.begin(), modes.remarks.end());
  if (!modes.frequency_stddevs.array().isNaN().all() || !modes.damping_ratio_stddevs.array().isNaN().all()) {
    available.stddev = VectorXd::Constant(layout.getRowCount(), kMissing);
    available.stddev(frequencies) = modes.frequency_stddevs;
    available.stddev(damping_ratios) = modes.damping_ratio_stddevs;
  }
}

}  // namespace

AvailableResponse readModesBeside(const Table& table, const MeasurementSpec& spec,
                                  const ResponseLayout& layout) {
  AvailableResponse available{VectorXd::Constant(layout.getRowCount(), kMissing), {}, 0, {}};
  if (spec.modes) {
    addModes(table, spec, layout, available);
  } else if (layout.modes > 0) {
    available.remarks.push_back("all modes, as measurement.modes names no table of them");
  }
  return available;
}

AvailableResponse readAvailable(const Table& table, const MeasurementSpec& spec, const ResponseLayout& layout,
                                double start, std::optional<double> interval,
                                const std::vector<FeatureSpec>& features) {
  AvailableResponse available{VectorXd::Constant(layout.getRowCount(), kMissing), {}, 0, {}};
  if (layout.modes > 0) {
    addModes(table, spec, layout, available);
  }
  if (layout.times.size() == 0) {
    return available;
  }
  RecordedColumns recording(table, spec, start);
  const double spacing = interval.value_or(calcSmallestStep(layout.times));
  for (Index output = 0; output < layout.getOutputCount(); ++output) {
    const auto o = static_cast<std::size_t>(output);
    const std::string& name = layout.output_names[o];
    const std::vector<Index> needed = listNeeded(layout.times, name, features);
    if (needed.empty()) {
      continue;
    }
    const std::string column = findColumnSpec(spec, name).name;
    const ClockedRows& clocked = recording.getRows(name);
    const Samples samples = readSamples(clocked, spec, layout, o);
    const std::optional<Bounds> range = findRange(spec, name);
    addOutput(clocked.rows, column, SampleFinder(samples, clocked.start, spacing, range), range, layout,
              output, needed, describeAssumedUnit(clocked.rows, makeTimeBase(spec, name, start)), available);
  }
  std::vector<std::string> remarks = recording.takeRemarks();
  available.remarks.insert(available.remarks.begin(), remarks.begin(), remarks.end());
  return available;
}

}  // namespace twinmap
