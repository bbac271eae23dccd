#include "framework/export/tracking/track_selftest.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "framework/base/json/json.hpp"
#include "framework/base/random/random.hpp"
#include "framework/export/c_code/runtime_sources.hpp"
#include "framework/tracking/track_answer.hpp"
#include "framework/tracking/track_likelihood.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index kMeasurements = 200;
constexpr std::uint64_t kOfLife = 1;  // replicate; those before are of the map's self-test

/// One measurement of the life.
struct Lived {
  Estimate estimate;
  double time = 0.0;
  VectorXd conditions;
  bool is_mismatch = false;
};

/// A machine in the middle of its bounds, whose first parameter steps.
class Life {
 public:
  Life(const ExportedModel& model, const ExportedTracking& tracking,
       const std::vector<TestedMeasurement>& measurements)
      : model_(model),
        tracking_(tracking),
        measurements_(measurements),
        random_(model.experiment.seed, RandomPurpose::kSelftest) {}

  Lived make(Index i) const {
    constexpr Index kMismatches = 37, kMissing = 11;  // one in so many
    constexpr double kHour = 3600.0, kUsual = 20.0, kAround = 3.0;
    Lived lived;
    lived.time = kHour * (static_cast<double>(i) + 0.2 * static_cast<double>(i % 3));
    lived.is_mismatch = i % kMismatches == kMismatches - 1;
    const Index c = tracking_.model.conditions;
    lived.conditions = VectorXd::NullaryExpr(c, [&](Index k) {
      return i % kMissing == kMissing - 1 ? std::numeric_limits<double>::quiet_NaN()
                                          : kUsual + kAround * drawNormal(i, 100 + k);
    });
    lived.estimate = estimate(i);
    return lived;
  }

 private:
  double drawNormal(Index i, Index channel) const {
    return random_.calcNormal(static_cast<std::uint64_t>(i), static_cast<std::uint64_t>(channel), kOfLife);
  }

  /// By how many standard deviations a measurement is off: the step, bad ones, and four bad ones in a row.
  VectorXd calcOffset(Index i) const {
    constexpr Index kStep = 90, kBad = 29, kRow = 150;
    constexpr double kStepSize = 6.0, kBadSize = 15.0;
    const Index p = tracking_.space.count();
    VectorXd offset = VectorXd::Zero(p);
    offset[0] = i >= kStep ? kStepSize : 0.0;
    if (i % kBad == kBad - 1 || (i >= kRow && i < kRow + 4)) {
      offset[i % p] += i % 2 == 0 ? kBadSize : -kBadSize;
    }
    return offset;
  }

  Estimate estimate(Index i) const {
    constexpr double kWithin = 0.98;  // of the bounds: logarithms are to exist
    const Estimate& like =
        measurements_[static_cast<std::size_t>(i) % measurements_.size()].inferred.by_estimator;
    const MatrixXd covariance = like.calcCovariance();
    const Index p = covariance.rows();
    const VectorXd noise = VectorXd::NullaryExpr(p, [&](Index j) { return drawNormal(i, j); });
    const VectorXd off =
        linalg::calcCholesky(covariance).lower * noise + like.stddev.cwiseProduct(calcOffset(i));
    Estimate made;
    made.mean.resize(p);
    for (Index j = 0; j < p; ++j) {
      const Bounds& bounds = model_.experiment.model.parameters[static_cast<std::size_t>(j)].bounds;
      const double half = 0.5 * (bounds.upper - bounds.lower);
      made.mean[j] =
          0.5 * (bounds.upper + bounds.lower) + std::clamp(off[j], -kWithin * half, kWithin * half);
    }
    made.stddev = like.stddev;
    made.correlation = calcCorrelation(covariance);
    return made;
  }

  const ExportedModel& model_;
  const ExportedTracking& tracking_;
  const std::vector<TestedMeasurement>& measurements_;
  RandomStream random_;
};

/// As TrackSession has it: no rows of what does not update.
TrackRecord makeRecord(const Lived& lived, const ExportedTracking& tracking) {
  const Index p = tracking.space.count();
  TrackRecord record{"", "", ""};
  if (lived.is_mismatch) {
    record.measurement.rows.resize(0, p);
    record.measurement.variances = VectorXd::Constant(p, std::numeric_limits<double>::infinity());
  } else {
    record.measurement = makeTrackMeasurement(lived.estimate, tracking.space, tracking.prior);
  }
  record.measurement.time = lived.time;
  record.measurement.conditions = lived.conditions;
  return record;
}

/// A row of numbers for each measurement.
struct Tables {
  MatrixXd mean, covariance, conditions, expected_mean, expected_sd, expected_walk;  // numbers x measurements
  VectorXd times;
  std::vector<int> mismatches{}, alarms{}, parameters{};
};

void note(Index i, const TrackPoint& point, long long alarms_before, const TrackView& view, Tables& tables) {
  const Json state = makeTrackState(point, view);
  for (Index j = 0; j < tables.mean.rows(); ++j) {
    const Json& of = state["parameters"][view.parameters[static_cast<std::size_t>(j)].name.text];
    tables.expected_mean(j, i) = of["mean"].get<double>();
    tables.expected_sd(j, i) = of["sd"].get<double>();
    tables.expected_walk(j, i) = of["walk"]["sd"].get<double>();
  }
  const bool is_alarm = point.alarm_count > alarms_before;
  const bool is_of_one = is_alarm && !point.alarms.back().is_of_several;
  tables.alarms.push_back(!is_alarm ? 0 : is_of_one ? 1 : 2);
  tables.parameters.push_back(is_of_one ? static_cast<int>(point.alarms.back().change.parameter) : 0);
}

Tables live(const ExportedModel& model, const ExportedTracking& tracking,
            const std::vector<TestedMeasurement>& measurements) {
  const Index p = tracking.space.count(), c = tracking.model.conditions;
  const Life life(model, tracking, measurements);
  const TrackView view{model.experiment.model.parameters, tracking.space, nullptr};
  TrackPoint point{tracking::Tracker(tracking.model)};
  const MatrixXd none(p, kMeasurements);
  Tables tables{none, MatrixXd(p * p, kMeasurements), MatrixXd(c, kMeasurements), none, none,
                none, VectorXd(kMeasurements)};
  for (Index i = 0; i < kMeasurements; ++i) {
    const Lived lived = life.make(i);
    const long long alarms = point.alarm_count;
    advance(makeRecord(lived, tracking), point);
    tables.mean.col(i) = lived.estimate.mean;
    tables.covariance.col(i) = flattenRows(lived.estimate.calcCovariance());
    tables.conditions.col(i) = lived.conditions.unaryExpr(
        [](double value) { return std::isfinite(value) ? value : std::numeric_limits<double>::lowest(); });
    tables.times[i] = lived.time;
    tables.mismatches.push_back(lived.is_mismatch ? 1 : 0);
    note(i, point, alarms, view, tables);
  }
  return tables;
}

}  // namespace

std::string makeTrackSelftest(const ExportedModel& model, const ExportedTracking& tracking,
                              const std::string& prefix, const std::vector<TestedMeasurement>& measurements) {
  const Tables lived = live(model, tracking, measurements);
  VectorXd half_widths(tracking.space.count());
  for (Index j = 0; j < half_widths.size(); ++j) {
    const Bounds& bounds = model.experiment.model.parameters[static_cast<std::size_t>(j)].bounds;
    half_widths[j] = 0.5 * (bounds.upper - bounds.lower);
  }
  CTables tables(CNumber::kDouble);
  // The prior of a slope is so wide that what is left of it behind two measurements has lost digits.
  tables.addNumber("tolerance", tracking.model.countSlopes() > 0 ? 2e-11 : 1e-11,
                   "In half-widths of the bounds and parts of the value.");
  tables.addWide("half_widths", half_widths, "Of the bounds.");
  tables.addWide("times", lived.times, "s");
  tables.addWide("measured_mean", flattenColumns(lived.mean), "Estimates: parameters of each measurement.");
  tables.addWide("measured_covariance", flattenColumns(lived.covariance), "Their covariances, row by row.");
  tables.addInts("measured_mismatch", lived.mismatches, "1: a model_mismatch, which does not update.");
  if (tracking.model.conditions > 0) {
    tables.addWide("measured_conditions", flattenColumns(lived.conditions), "Least of all: missing.");
  }
  tables.addWide("expected_mean", flattenColumns(lived.expected_mean), "The belief behind each.");
  tables.addWide("expected_sd", flattenColumns(lived.expected_sd), "Its standard deviations.");
  tables.addWide("expected_walk", flattenColumns(lived.expected_walk), "How far each walks in an interval.");
  tables.addInts("expected_alarm", lived.alarms, "twinmap_track_alarm.");
  tables.addInts("expected_parameter", lived.parameters, "Of a change.");
  const std::string text = fmt::format("enum {{ MEASUREMENTS = {} }};\n\n", kMeasurements) + tables.getText();
  return fillSlot(renameC(std::string(getRuntimeSource("track_selftest.c")), prefix), "@TABLES@\n", text);
}

}  // namespace twinmap
