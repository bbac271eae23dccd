#include "framework/data/measurement/bridged_gaps.hpp"

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

/// What is not there after sample number `before`.
struct Gap {
  Index before = 0;
  VectorXd due;          ///< when samples were due, s
  bool is_late = false;  ///< the next one of a held signal, due last: its value was there when it was due

  Index countLost() const { return due.size() - (is_late ? 1 : 0); }
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
    std::vector<Gap> gaps;
    for (Index i = 0; i + 1 < times.size(); ++i) {
      const bool may_change = isHeld() && getChange(i, i + 1) != 0.0;
      const bool is_long = times[i + 1] - times[i] > kLongest * step_;
      if (times[i + 1] > begin && times[i] < end && (is_long || may_change)) {
        Gap gap = makeGap(i);
        if (gap.due.size() > 0) {
          gaps.push_back(std::move(gap));
        }
      }
    }
    return gaps;
  }

  VectorXd bridge(const Gap& gap) const {
    const Index next = gap.before + 1, lost = gap.countLost();
    VectorXd values_due = VectorXd::Constant(gap.due.size(), values[next]);
    values_due.head(lost) = bridge(gap.due.head(lost), gap.before, next);
    return values_due;
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
  static constexpr double kJitter = 0.02;  // of a step: by so much a held value changes late unnoticed

  Gap makeGap(Index before) const {
    const double from = times[before] + kJitter * step_, to = times[before + 1] - kJitter * step_;
    const double tick = findTick(before);
    std::vector<double> due;
    for (double n = std::ceil((from - tick) / step_); tick + n * step_ < to; n += 1.0) {
      due.push_back(tick + n * step_);
    }
    const bool is_late = !due.empty() && times[before + 1] - due.back() < (1.0 - kJitter) * step_;
    return {before, Eigen::Map<const VectorXd>(due.data(), static_cast<Index>(due.size())),
            isHeld() && is_late};
  }

  /// A time at which a sample was due, so that they are due in whole steps from there. It is that of the
  /// sample nearby with which most others keep time. It is this one's own without a majority.
  double findTick(Index near) const {
    constexpr Index kReach = 8;
    const Index first = std::max<Index>(0, near - kReach),
                last = std::min(times.size() - 1, near + 1 + kReach);
    Index best = near, most = 0;
    for (Index i = first; i <= last; ++i) {
      const VectorXd steps = (times.segment(first, last - first + 1).array() - times[i]) / step_;
      const Index keep = ((steps.array() - steps.array().round()).abs() < kJitter).count();
      best = keep > most ? i : best;
      most = std::max(most, keep);
    }
    return times[2 * most > last - first + 1 ? best : near];
  }

  const TableInterpolation interpolation_;
  const double step_;
};

/// What the bridge of a gap errs by in whole stretches as long: a row each.
MatrixXd listErrors(const Signal& signal, const Gap& gap, Index reach) {
  const double change = signal.getChange(gap.before, gap.before + 1);
  const Index from = std::max<Index>(0, gap.before - reach);
  const Index lost = gap.countLost();
  const Index to = std::min(signal.times.size() - lost - 1, gap.before + reach);
  std::vector<VectorXd> rows;
  for (Index i = from; i < to; ++i) {
    const Index next = i + lost + 1;
    const double own = signal.getChange(i, next);
    if (!signal.isWhole(i, next) || (signal.isHeld() && (own == 0.0) != (change == 0.0))) {
      continue;
    }
    const VectorXd errors =
        signal.values.segment(i + 1, lost) - signal.bridge(signal.times.segment(i + 1, lost), i, next);
    rows.emplace_back(signal.isHeld() && change != 0.0 ? VectorXd(errors * (change / own)) : errors);
  }
  MatrixXd listed(static_cast<Index>(rows.size()), lost);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    listed.row(static_cast<Index>(i)) = rows[i].transpose();
  }
  return listed;
}

Index countStretches(const Signal& signal, const Gap& gap) {
  Index count = 0;
  for (Index i = 0; i + gap.countLost() + 1 < signal.times.size(); ++i) {
    count += signal.isWhole(i, i + gap.countLost() + 1) ? 1 : 0;
  }
  return count;
}

/// Of a value that changes once, at any of the times alike.
MatrixXd calcSingleChange(const Signal& signal, const Gap& gap) {
  const double change = signal.getChange(gap.before, gap.before + 1);
  const Index lost = gap.countLost();
  const auto all = static_cast<double>(lost + 1);
  return MatrixXd::NullaryExpr(lost, lost, [&](Index i, Index j) {
    const auto first = static_cast<double>(std::min(i, j) + 1),
               last = static_cast<double>(std::max(i, j) + 1);
    return change * change * first / all * (1.0 - last / all);
  });
}

/// The covariance of what the bridge of lost samples errs by.
MatrixXd calcLostCovariance(const Signal& signal, const Gap& gap) {
  constexpr Index kNear = 50;  // samples: a signal's spectrum changes
  const Index lost = gap.countLost();
  MatrixXd errors = listErrors(signal, gap, std::max(kNear, kFewest * (lost + 1)));
  if (errors.rows() < kFewest) {
    errors = listErrors(signal, gap, signal.times.size());
  }
  if (errors.rows() < kFewest && signal.isHeld()) {
    return calcSingleChange(signal, gap);
  }
  return errors.rows() == 0 ? MatrixXd(MatrixXd::Zero(lost, lost))
                            : MatrixXd(errors.transpose() * errors / static_cast<double>(errors.rows()));
}

/// The same of all that were due: a late one's value may have changed before it came or when it was due.
MatrixXd calcCovariance(const Signal& signal, const Gap& gap) {
  const double change = signal.getChange(gap.before, gap.before + 1);
  MatrixXd covariance = MatrixXd::Zero(gap.due.size(), gap.due.size());
  covariance(gap.due.size() - 1, gap.due.size() - 1) = 0.25 * change * change;
  if (const Index lost = gap.countLost(); lost > 0) {
    covariance.topLeftCorner(lost, lost) = calcLostCovariance(signal, gap);
  }
  return covariance;
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
    const VectorXd& times = gap.due;
    const VectorXd values = signal.bridge(gap);
    const auto at = static_cast<std::ptrdiff_t>(static_cast<std::size_t>(gap.before) + 1 + added);
    table.times.insert(table.times.begin() + at, times.begin(), times.end());
    table.values.insert(table.values.begin() + at, values.begin(), values.end());
    addUnknown(table, static_cast<std::size_t>(at), calcCovariance(signal, gap));
    added += static_cast<std::size_t>(times.size());
    lost += times.size();
    longest = std::max(longest, signal.times[gap.before + 1] - signal.times[gap.before]);
  }
  if (!gaps.empty()) {
    table.bridged =
        fmt::format("{} of its samples are late or lost, the longest step {} where {} is usual: interpolated",
                    lost, describeTime(longest), describeTime(signal.getStep()));
  }
}

}  // namespace twinmap
