#include "framework/tracking/track_history.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <sstream>
#include <stdexcept>

#include "framework/base/files/atomic_file.hpp"
#include "framework/base/text/csv.hpp"
#include "framework/estimation/interval_factor.hpp"
#include "kernels/tracking/smoother.hpp"
#include "kernels/tracking/tracker.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

TrackHistory::TrackHistory(std::filesystem::path file, std::uint64_t bytes)
    : file_(std::move(file)), bytes_(bytes) {
  const std::uint64_t there = std::filesystem::exists(file_) ? std::filesystem::file_size(file_) : 0;
  if (there < bytes) {
    throw std::runtime_error(
        fmt::format("{}: the history has {} bytes, the state beside it belongs to {}; "
                    "restore it, or name another --state",
                    file_.string(), there, bytes));
  }
  if (there > bytes) {
    std::filesystem::resize_file(file_, bytes);
  }
}

void TrackHistory::add(const TrackRecord& record) {
  const std::string line = writeRecord(record) + "\n";
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(file_.c_str(), "ab"), &std::fclose);
  if (!file || std::fwrite(line.data(), 1, line.size(), file.get()) != line.size() ||
      std::fflush(file.get()) != 0) {
    std::error_code ignored;
    std::filesystem::resize_file(file_, bytes_, ignored);  // no half of a line stays
    throw std::runtime_error(file_.string() + ": cannot be written");
  }
  bytes_ += line.size();
}

std::vector<TrackRecord> TrackHistory::read(Index parameters, Index conditions) const {
  std::vector<TrackRecord> records;
  if (bytes_ == 0) {
    return records;
  }
  std::istringstream lines(readBytes(file_));
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    try {
      records.push_back(readRecord(line, parameters, conditions));
    } catch (const std::runtime_error& error) {
      throw std::runtime_error(fmt::format("{}:{}: {}", file_.string(), number, error.what()));
    }
  }
  std::stable_sort(records.begin(), records.end(),
                   [](const TrackRecord& one, const TrackRecord& other) { return one.isBefore(other); });
  return records;
}

namespace {

using tracking::SmoothedStep;

/// A run through all measurements, forwards.
struct Run {
  std::vector<SmoothedStep> steps;
  std::vector<bool> used;
  MatrixXd filtered, filtered_variances;  // p x N, coordinates
  tracking::Tracker tracker;
};

/// Variance that parameters have again from a measurement on.
void forget(const VectorXd& variance, std::size_t from, Run& run) {
  VectorXd& forgotten = run.steps[from].forgotten;
  forgotten = forgotten.size() > 0 ? VectorXd(forgotten + variance) : variance;
}

/// What was left out as bad before a change was announced is of the time after it.
void takeLast(std::size_t from, std::size_t last, Run& run) {
  for (std::size_t i = last + 1; i-- > from && (i == last || !run.used[i]);) {
    run.used[i] = true;
  }
}

void noteChange(const tracking::Step& step, const std::vector<TrackRecord>& records, std::size_t i,
                Run& run) {
  const Index p = run.tracker.getModel().countParameters();
  if (step.change) {
    std::size_t from = i;
    while (from > 0 && records[from].measurement.time > step.change->time) {
      --from;
    }
    const double size = step.change->size, stddev = step.change->stddev;
    forget((size * size + stddev * stddev) * VectorXd::Unit(p, step.change->parameter), from, run);
    takeLast(from, i, run);
  } else if (step.has_begun_anew) {
    std::size_t from = i;
    while (from > 0 && !run.used[from - 1]) {
      --from;
    }
    forget(run.tracker.getModel().covariance.diagonal(), from, run);
    takeLast(from, i, run);
  }
}

/// Variances of slopes and coefficients, whose units are known by now.
VectorXd calcUnits(const tracking::Tracker& tracker) {
  const tracking::Model& model = tracker.getModel();
  VectorXd units = VectorXd::Zero(model.countStates());
  units.tail(units.size() - model.countParameters()) = tracker.calcUnits();
  return units;
}

Run runForwards(const std::vector<TrackRecord>& records, const tracking::Model& model) {
  const Index p = model.countParameters(), count = static_cast<Index>(records.size());
  Run run{std::vector<SmoothedStep>(records.size()), std::vector<bool>(records.size()), MatrixXd(p, count),
          MatrixXd(p, count), tracking::Tracker(model)};
  for (std::size_t i = 0; i < records.size(); ++i) {
    const tracking::Step step = run.tracker.advance(records[i].measurement);
    run.used[i] = step.is_used;
    run.steps[i].dt = i > 0 ? records[i].measurement.time - records[i - 1].measurement.time : 0.0;
    noteChange(step, records, i, run);
    const tracking::Belief belief = run.tracker.calcBelief();
    run.filtered.col(static_cast<Index>(i)) = belief.mean.head(p);
    run.filtered_variances.col(static_cast<Index>(i)) = belief.covariance.diagonal().head(p);
  }
  const tracking::TrackerState& state = run.tracker.getState();
  for (std::size_t i = 0; i < records.size(); ++i) {
    run.steps[i].rows = run.used[i] ? makeStateRows(model, records[i].measurement, state.reference,
                                                    state.spread, state.belief)
                                    : tracking::StateRows{MatrixXd(model.countStates(), 0), VectorXd()};
  }
  if (!records.empty()) {
    run.steps.front().units = calcUnits(run.tracker);
  }
  return run;
}

/// One parameter's smoothed course over all rates that it may have.
void integrateRates(const Run& run, std::size_t unknown, tracking::Course& course) {
  const tracking::TrackerState& state = run.tracker.getState();
  tracking::RateFilters filters = state.filters[unknown];
  const Index j = filters.parameter;
  std::vector<tracking::Course> courses;
  filters.log_weights = tracking::makeLogRatePrior();
  for (int g = 0; g < tracking::kRates; ++g) {
    VectorXd rates = run.tracker.calcRates();
    const double ratio = tracking::getRateRatio(g);
    rates[j] = state.interval > 0.0 ? ratio * ratio * state.variances[j] / state.interval : 0.0;
    tracking::Smoothed smoothed = smooth(run.tracker.getModel(), run.steps, rates);
    filters.log_weights[g] += smoothed.log_likelihood;
    courses.push_back(std::move(smoothed.course));
  }
  const VectorXd weights = calcRatePosterior(filters).calcFilterWeights();
  VectorXd mean = VectorXd::Zero(course.means.cols()), square = mean;
  for (int g = 0; g < tracking::kRates; ++g) {
    const tracking::Course& one = courses[static_cast<std::size_t>(g)];
    mean += weights[g] * one.means.row(j).transpose();
    square += weights[g] * (one.means.row(j).cwiseAbs2() + one.stddevs.row(j).cwiseAbs2()).transpose();
  }
  course.means.row(j) = mean.transpose();
  course.stddevs.row(j) = (square - mean.cwiseAbs2()).cwiseMax(0.0).cwiseSqrt().transpose();
}

}  // namespace

TrackCourse calcTrackCourse(std::vector<TrackRecord> records, const tracking::Model& model) {
  const Run run = runForwards(records, model);
  TrackCourse course{std::move(records), run.used, run.filtered, run.filtered_variances.cwiseSqrt(), {}, {}};
  if (course.records.empty()) {
    return course;
  }
  tracking::Course smoothed = smooth(model, run.steps, run.tracker.calcRates()).course;
  for (std::size_t u = 0; u < run.tracker.getState().filters.size(); ++u) {
    integrateRates(run, u, smoothed);
  }
  course.smoothed = std::move(smoothed.means);
  course.smoothed_stddevs = std::move(smoothed.stddevs);
  return course;
}

namespace {

/// "mean,sd,lower,upper" in the parameter's unit; the interval is of 95 %.
void addBand(const TrackSpace& space, Index j, double mean, double stddev, CsvRow& row) {
  const double value = space.toValue(j, mean);
  for (const double number :
       {value, stddev / space.calcSlope(j, value), space.toValue(j, mean - kNormal95 * stddev),
        space.toValue(j, mean + kNormal95 * stddev)}) {
    row.push_back(fmt::format("{}", number));
  }
}

}  // namespace

std::string makeTrackCsv(const TrackCourse& course, const std::vector<ParameterSpec>& parameters,
                         const TrackSpace& space) {
  std::vector<CsvRow> rows{{"time", "source", "status", "used", "parameter", "unit", "mean", "sd", "lower",
                            "upper", "smoothed_mean", "smoothed_sd", "smoothed_lower", "smoothed_upper"}};
  for (std::size_t i = 0; i < course.records.size(); ++i) {
    const TrackRecord& record = course.records[i];
    for (std::size_t p = 0; p < parameters.size(); ++p) {
      const auto j = static_cast<Index>(p), n = static_cast<Index>(i);
      rows.push_back({fmt::format("{}", record.measurement.time), record.source, record.status,
                      course.used[i] ? "yes" : "no", parameters[p].name.text, parameters[p].unit});
      addBand(space, j, course.filtered(j, n), course.filtered_stddevs(j, n), rows.back());
      addBand(space, j, course.smoothed(j, n), course.smoothed_stddevs(j, n), rows.back());
    }
  }
  return makeCsv(rows);
}

}  // namespace twinmap
