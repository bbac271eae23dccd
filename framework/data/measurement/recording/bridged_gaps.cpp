#include "framework/data/measurement/recording/bridged_gaps.hpp"

#include <fmt/core.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "framework/data/measurement/lagrange.hpp"
#include "framework/data/measurement/time_series.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index kFewest = 10;  // stretches: the size of what they err by is known to a quarter

/// So many samples lost after number `before`.
struct Gap {
  Index before = 0, lost = 0;
  bool is_late = false;  ///< the next one of a held signal: its value was there when it was due
};

class Signal {
 public:
  static constexpr double kLongest = 1.5;  // median steps: a sample less is two of them

  explicit Signal(const TableSpec& table)
      : times(Eigen::Map<const VectorXd>(table.times.data(), static_cast<Index>(table.times.size()))),
        values(Eigen::Map<const VectorXd>(table.values.data(), static_cast<Index>(table.values.size()))),
        interpolation_(table.interpolation),
        step_(calcMedianStep(times)) {}

  bool isHeld() const { return interpolation_ == TableInterpolation::kHold; }
  double getStep() const { return step_; }
  double getChange(Index from, Index to) const { return values[to] - values[from]; }

  std::vector<Gap> listGaps(double begin, double end) const {
    constexpr double kLost = 1.75;  // steps; a late sample's is shorter than that over one that was lost
    constexpr double kLate = 1.1;   // of a held value that changes; stamps that jitter by less are usual
    std::vector<Gap> gaps;
    for (Index i = 0; i + 1 < times.size(); ++i) {
      const double steps = (times[i + 1] - times[i]) / step_;
      const bool changes = isHeld() && getChange(i, i + 1) != 0.0;
      if (times[i + 1] > begin && times[i] < end && steps > (changes ? kLate : kLongest)) {
        gaps.push_back(
            {i, std::max<Index>(1, static_cast<Index>(std::lround(steps)) - 1), isHeld() && steps < kLost});
      }
    }
    return gaps;
  }

  /// The time of lost sample number k, from 1 on.
  double calcTime(const Gap& gap, Index k) const {
    return times[gap.before] + static_cast<double>(k) * step_;
  }

  VectorXd bridge(const VectorXd& at, const Gap& gap) const {
    const Index next = gap.before + 1;
    return gap.is_late ? VectorXd(VectorXd::Constant(gap.lost, values[next])) : bridge(at, gap.before, next);
  }

  /// What stands in the place of samples, the next one that is there being number `next`.
  VectorXd bridge(const VectorXd& at, Index before, Index next) const {
    if (isHeld()) {
      const VectorXd shares =
          VectorXd::LinSpaced(at.size(), 1.0, static_cast<double>(at.size())) / (at.size() + 1.0);
      return values[before] + shares.array() * getChange(before, next);
    }
    std::vector<Index> points{before, next};
    if (interpolation_ == TableInterpolation::kCubic && before > 0 && next + 1 < times.size()) {
      points = {before - 1, before, next, next + 1};
    }
    const VectorXd known_times = times(points), known = values(points);
    return at.unaryExpr([&](double t) {
      return apply(makeLagrange(known_times, 0, static_cast<int>(points.size()), t), known);
    });
  }

  /// Whether samples first .. last and their neighbours are all there.
  bool isWhole(Index first, Index last) const {
    for (Index i = first; i < last; ++i) {
      if (times[i + 1] - times[i] > kLongest * step_) {
        return false;
      }
    }
    return true;
  }

  const VectorXd times, values;

 private:
  const TableInterpolation interpolation_;
  const double step_;
};

/// What the bridge of a gap errs by in whole stretches as long: a row each.
MatrixXd listErrors(const Signal& signal, const Gap& gap, Index reach) {
  const double change = signal.getChange(gap.before, gap.before + 1);
  const Index from = std::max<Index>(0, gap.before - reach);
  const Index to = std::min(signal.times.size() - gap.lost - 1, gap.before + reach);
  std::vector<VectorXd> rows;
  for (Index i = from; i < to; ++i) {
    const Index next = i + gap.lost + 1;
    const double own = signal.getChange(i, next);
    if (!signal.isWhole(i, next) || (signal.isHeld() && (own == 0.0) != (change == 0.0))) {
      continue;
    }
    const VectorXd errors = signal.values.segment(i + 1, gap.lost) -
                            signal.bridge(signal.times.segment(i + 1, gap.lost), i, next);
    rows.emplace_back(signal.isHeld() && change != 0.0 ? VectorXd(errors * (change / own)) : errors);
  }
  MatrixXd listed(static_cast<Index>(rows.size()), gap.lost);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    listed.row(static_cast<Index>(i)) = rows[i].transpose();
  }
  return listed;
}

Index countStretches(const Signal& signal, const Gap& gap) {
  Index count = 0;
  for (Index i = 0; i + gap.lost + 1 < signal.times.size(); ++i) {
    count += signal.isWhole(i, i + gap.lost + 1) ? 1 : 0;
  }
  return count;
}

/// Of a value that changes once, at any of the times alike.
MatrixXd calcSingleChange(const Signal& signal, const Gap& gap) {
  const double change = signal.getChange(gap.before, gap.before + 1);
  const auto all = static_cast<double>(gap.lost + 1);
  return MatrixXd::NullaryExpr(gap.lost, gap.lost, [&](Index i, Index j) {
    const auto first = static_cast<double>(std::min(i, j) + 1),
               last = static_cast<double>(std::max(i, j) + 1);
    return change * change * first / all * (1.0 - last / all);
  });
}

/// The covariance of what the bridge of a gap errs by.
MatrixXd calcCovariance(const Signal& signal, const Gap& gap) {
  if (gap.is_late) {
    return calcSingleChange(signal, gap);
  }
  constexpr Index kNear = 50;  // samples: a signal's spectrum changes
  MatrixXd errors = listErrors(signal, gap, std::max(kNear, kFewest * (gap.lost + 1)));
  if (errors.rows() < kFewest) {
    errors = listErrors(signal, gap, signal.times.size());
  }
  if (errors.rows() < kFewest && signal.isHeld()) {
    return calcSingleChange(signal, gap);
  }
  return errors.rows() == 0 ? MatrixXd(MatrixXd::Zero(gap.lost, gap.lost))
                            : MatrixXd(errors.transpose() * errors / static_cast<double>(errors.rows()));
}

void addUnknown(TableSpec& table, std::size_t first, const MatrixXd& covariance) {
  constexpr double kSmallest = 1e-3;  // of the largest variance
  const linalg::SymmetricEigen eigen = linalg::calcSymmetricEigen(covariance);
  const double largest = eigen.values[eigen.values.size() - 1];
  for (Index i = 0; i < eigen.values.size(); ++i) {
    if (eigen.values[i] > kSmallest * largest && largest > 0.0) {
      const VectorXd changes = std::sqrt(eigen.values[i]) * eigen.vectors.col(i);
      table.unknown.push_back({first, {changes.begin(), changes.end()}});
    }
  }
}

void requireBridgeable(const Signal& signal, const Gap& gap, const std::optional<double>& longest,
                       const std::string& source, double start) {
  const double from = signal.times[gap.before], length = signal.times[gap.before + 1] - from;
  const bool is_known = longest ? length <= *longest : countStretches(signal, gap) >= kFewest;
  if (!is_known) {
    throw MeasurementError(fmt::format(
        "{}: has a gap of {} after t = {} in a signal that is needed, {}", source, describeTime(length),
        describeTime(start + from),
        longest ? fmt::format("longer than max_gap, {}", describeTime(*longest))
                : std::string("too long to tell from the rest what it hides; start elsewhere (--start), or "
                              "give measured.max_gap to interpolate all the same")));
  }
}

}  // namespace

void bridgeGaps(TableSpec& table, const std::string& source, double start, double begin, double end) {
  table.unknown.clear();
  table.bridged.clear();
  if (table.times.size() < 2) {
    return;
  }
  const Signal signal(table);
  const std::vector<Gap> gaps = signal.listGaps(begin, end);
  double longest = 0.0;
  Index lost = 0;
  std::size_t added = 0;
  for (const Gap& gap : gaps) {
    requireBridgeable(signal, gap, table.measured->max_gap, source, start);
    const VectorXd times =
        VectorXd::NullaryExpr(gap.lost, [&](Index k) { return signal.calcTime(gap, k + 1); });
    const VectorXd values = signal.bridge(times, gap);
    const auto at = static_cast<std::ptrdiff_t>(static_cast<std::size_t>(gap.before) + 1 + added);
    table.times.insert(table.times.begin() + at, times.begin(), times.end());
    table.values.insert(table.values.begin() + at, values.begin(), values.end());
    addUnknown(table, static_cast<std::size_t>(at), calcCovariance(signal, gap));
    added += static_cast<std::size_t>(gap.lost);
    lost += gap.lost;
    longest = std::max(longest, signal.times[gap.before + 1] - signal.times[gap.before]);
  }
  if (!gaps.empty()) {
    table.bridged = fmt::format(
        "{} of its samples are late or lost, the longest step {} where {} is usual: "
        "interpolated",
        lost, describeTime(longest), describeTime(signal.getStep()));
  }
}

}  // namespace twinmap
