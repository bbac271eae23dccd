#include "kernels/tracking/whole_course.hpp"

#include <algorithm>
#include <cmath>

namespace twinmap::tracking {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// What is forgotten before a measurement.
struct Forgotten {
  std::size_t from = 0;
  VectorXd variance;    // p
  bool is_sure = true;  // else what came later says whether it was a change:
  double log_prior_odds = 0.0;
};

/// A run through all measurements, forwards.
struct Run {
  std::vector<SmoothedStep> steps;
  std::vector<bool> used;
  Course filtered;
  Tracker tracker;
  std::vector<Forgotten> forgotten;
};

/// What was left out as bad before a change was announced is of the time after it. Whether there was any.
bool takeLast(std::size_t from, std::size_t last, Run& run) {
  bool has_taken = false;
  for (std::size_t i = last + 1; i-- > from && (i == last || !run.used[i]);) {
    has_taken = has_taken || !run.used[i];
    run.used[i] = true;
  }
  return has_taken;
}

void noteChange(const Step& step, const std::vector<Measurement>& measurements, std::size_t i, Run& run) {
  const Model& model = run.tracker.getModel();
  std::size_t from = i;
  if (step.change) {
    while (from > 0 && measurements[from].time > step.change->time) {
      --from;
    }
    const double size = step.change->size, stddev = step.change->stddev;
    const VectorXd one = VectorXd::Unit(model.countParameters(), step.change->parameter);
    const bool is_sure = takeLast(from, i, run);
    run.forgotten.push_back(
        {from, (size * size + stddev * stddev) * one, is_sure, step.change->log_prior_odds});
  } else if (step.has_begun_anew) {
    while (from > 0 && !run.used[from - 1]) {
      --from;
    }
    takeLast(from, i, run);
    run.forgotten.push_back({from, model.covariance.diagonal()});
  }
}

/// Variances of slopes and coefficients, whose units are known by now.
VectorXd calcUnits(const Tracker& tracker) {
  const Model& model = tracker.getModel();
  VectorXd units = VectorXd::Zero(model.countStates());
  units.tail(units.size() - model.countParameters()) = tracker.calcUnits();
  return units;
}

void forget(const Forgotten& one, double factor, Run& run) {
  VectorXd& variance = run.steps[one.from].forgotten;
  variance =
      variance.size() > 0 ? VectorXd(variance + factor * one.variance) : VectorXd(factor * one.variance);
}

/// Takes back changes that were announced and that all measurements together speak against.
void forgetChanges(Run& run) {
  for (const Forgotten& one : run.forgotten) {
    forget(one, 1.0, run);
  }
  const VectorXd rates = run.tracker.calcRates();
  const auto calcLogLikelihood = [&] {
    return smooth(run.tracker.getModel(), run.steps, rates).log_likelihood;
  };
  for (const Forgotten& one : run.forgotten) {
    if (!one.is_sure) {
      const double with = calcLogLikelihood();
      forget(one, -1.0, run);
      if (with + one.log_prior_odds > calcLogLikelihood()) {
        forget(one, 1.0, run);
      }
    }
  }
}

Run runForwards(const std::vector<Measurement>& measurements, const Model& model) {
  const Index p = model.countParameters(), count = static_cast<Index>(measurements.size());
  Run run{std::vector<SmoothedStep>(measurements.size()),
          std::vector<bool>(measurements.size()),
          {MatrixXd(p, count), MatrixXd(p, count)},
          Tracker(model),
          {}};
  std::vector<Measurement> taken;
  for (std::size_t i = 0; i < measurements.size(); ++i) {
    const Step step = run.tracker.advance(measurements[i]);
    run.used[i] = step.is_used;
    run.steps[i].dt = i > 0 ? measurements[i].time - measurements[i - 1].time : 0.0;
    noteChange(step, measurements, i, run);
    taken.push_back(step.taken);
    const Belief belief = run.tracker.calcBelief();
    run.filtered.means.col(static_cast<Index>(i)) = belief.mean.head(p);
    run.filtered.stddevs.col(static_cast<Index>(i)) = belief.covariance.diagonal().head(p).cwiseSqrt();
  }
  const TrackerState& state = run.tracker.getState();
  for (std::size_t i = 0; i < measurements.size(); ++i) {
    run.steps[i].rows = run.used[i]
                            ? makeStateRows(model, taken[i], state.reference, state.spread, state.belief)
                            : StateRows{MatrixXd(model.countStates(), 0), VectorXd()};
  }
  if (!measurements.empty()) {
    run.steps.front().units = calcUnits(run.tracker);
  }
  forgetChanges(run);
  return run;
}

/// One parameter's smoothed course over all rates that it may have.
void integrateRates(const Run& run, std::size_t unknown, Course& course) {
  const TrackerState& state = run.tracker.getState();
  RateFilters filters = state.filters[unknown];
  const Index j = filters.parameter;
  std::vector<Course> courses;
  filters.log_weights = makeLogRatePrior();
  for (int g = 0; g < kRates; ++g) {
    VectorXd rates = run.tracker.calcRates();
    const double ratio = getRateRatio(g);
    rates[j] = state.interval > 0.0 ? ratio * ratio * state.variances[j] / state.interval : 0.0;
    Smoothed smoothed = smooth(run.tracker.getModel(), run.steps, rates);
    filters.log_weights[g] += smoothed.log_likelihood;
    courses.push_back(std::move(smoothed.course));
  }
  const VectorXd weights = calcRatePosterior(filters).calcFilterWeights();
  VectorXd mean = VectorXd::Zero(course.means.cols()), square = mean;
  for (int g = 0; g < kRates; ++g) {
    const Course& one = courses[static_cast<std::size_t>(g)];
    mean += weights[g] * one.means.row(j).transpose();
    square += weights[g] * (one.means.row(j).cwiseAbs2() + one.stddevs.row(j).cwiseAbs2()).transpose();
  }
  course.means.row(j) = mean.transpose();
  course.stddevs.row(j) = (square - mean.cwiseAbs2()).cwiseMax(0.0).cwiseSqrt().transpose();
}

}  // namespace

WholeCourse calcWholeCourse(const Model& model, const std::vector<Measurement>& measurements) {
  const Run run = runForwards(measurements, model);
  WholeCourse course{run.used, run.filtered, {}};
  if (measurements.empty()) {
    return course;
  }
  course.smoothed = smooth(model, run.steps, run.tracker.calcRates()).course;
  for (std::size_t u = 0; u < run.tracker.getState().filters.size(); ++u) {
    integrateRates(run, u, course.smoothed);
  }
  const MatrixXd variances =
      course.smoothed.stddevs.cwiseAbs2().colwise() + run.tracker.calcSharedVariances();
  course.smoothed.stddevs = variances.cwiseSqrt();
  return course;
}

}  // namespace twinmap::tracking
