#include "kernels/tracking/tracker.hpp"

#include <algorithm>
#include <cmath>

#include "kernels/tracking/modes.hpp"

namespace twinmap::tracking {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr double kBad = 0.05;        // share of measurements that say nothing
constexpr double kSurprises = 10.0;  // of 20: more than any noise or a change makes
constexpr double kMemory = 20.0;     // measurements
constexpr double kNever = 1e300;
// Standard deviations above the mean at which unknown rates move what changes are seen against: a rate that
// is taken for too small is called a change. Of the belief itself rates are integrated out.
constexpr double kAbove = 0.6;

/// log of the ratio of the densities of the length r of k standardized values. Half-Cauchy of scale 10, as
/// bad measurements are anywhere, over chi of k degrees; with the odds of being bad. What is nearer than
/// noise is on average is as good as that.
double calcLogBad(double chi_square, double degrees) {
  constexpr double kScale = 10.0, kLogTwo = 0.69314718055994531, kPi = 3.14159265358979324;
  chi_square = std::max(chi_square, degrees);
  const double length = std::sqrt(chi_square);
  const double log_bad = std::log(2.0 * kScale / kPi) - std::log(kScale * kScale + chi_square);
  const double log_good = (degrees - 1.0) * std::log(length) - 0.5 * chi_square -
                          (0.5 * degrees - 1.0) * kLogTwo - std::lgamma(0.5 * degrees);
  return std::log(kBad / (1.0 - kBad)) + log_bad - log_good;
}

MatrixXd collectLogWeights(const std::vector<RateFilters>& filters) {
  MatrixXd log_weights(kRates, static_cast<Index>(filters.size()));
  for (std::size_t u = 0; u < filters.size(); ++u) {
    log_weights.col(static_cast<Index>(u)) = filters[u].log_weights;
  }
  return log_weights;
}

}  // namespace

Tracker::Tracker(Model model) : model_(std::move(model)) {
  const Index c = model_.conditions;
  state_.belief = makePrior(model_);
  state_.variances = VectorXd::Zero(model_.countParameters());
  state_.reference = VectorXd::Constant(c, std::numeric_limits<double>::quiet_NaN());
  state_.spread = state_.condition_counts = VectorXd::Zero(c);
  for (Index j = 0; j < model_.countParameters(); ++j) {
    if (std::isnan(model_.drifts[static_cast<std::size_t>(j)].rate)) {
      state_.filters.push_back({j, std::vector<Belief>(kRates, state_.belief), makeLogRatePrior()});
    }
  }
}

double Tracker::calcUnitRate(Index parameter) const {
  return state_.interval > 0.0 ? state_.variances[parameter] / state_.interval : 0.0;
}

VectorXd Tracker::calcRates(double above) const {
  VectorXd rates(model_.countParameters());
  for (Index j = 0; j < rates.size(); ++j) {
    rates[j] = state_.widening * model_.drifts[static_cast<std::size_t>(j)].rate;
  }
  for (const RateFilters& filters : state_.filters) {
    const RatePosterior posterior = calcRatePosterior(filters);
    rates[filters.parameter] =
        (posterior.calcMeanSquare() + above * posterior.calcSquareStddev()) * calcUnitRate(filters.parameter);
  }
  return rates;
}

VectorXd Tracker::calcRatios() const {
  return (calcRates(0.0) * state_.interval).cwiseQuotient(state_.variances).cwiseSqrt();
}

namespace {

/// Slopes and coefficients get the prior that their units allow, once these are known.
template <class Visit>
void visitBeliefs(TrackerState& state, const Visit& visit) {
  visit(state.belief);
  for (RateFilters& filters : state.filters) {
    for (Belief& belief : filters.beliefs) {
      visit(belief);
    }
  }
}

}  // namespace

/// One unit of the parameter within the first interval; ten of it over the condition's first value.
VectorXd Tracker::calcUnits() const {
  constexpr double kUnits = 10.0;
  const Index slopes = model_.countSlopes();
  VectorXd units = VectorXd::Zero(slopes + static_cast<Index>(model_.follows.size()));
  if (state_.interval > 0.0) {
    units.head(slopes).setConstant(1.0 / (state_.interval * state_.interval));
  }
  for (std::size_t f = 0; f < model_.follows.size(); ++f) {
    const Follow& follow = model_.follows[f];
    const double first = state_.reference[follow.condition];
    const double size = first != 0.0 ? std::abs(first) : 1.0;
    const double stddev = follow.stddev > 0.0 ? follow.stddev : kUnits / size;
    units[slopes + static_cast<Index>(f)] = std::isfinite(first) ? stddev * stddev : 0.0;
  }
  return units;
}

/// What has become known gets its prior.
void Tracker::setUnits(const VectorXd& before) {
  const VectorXd units = calcUnits();
  const Index p = model_.countParameters();
  visitBeliefs(state_, [&](Belief& belief) {
    for (Index s = 0; s < units.size(); ++s) {
      belief.covariance(p + s, p + s) += units[s] - before[s];
    }
  });
}

void Tracker::noteConditions(const Measurement& measurement) {
  const VectorXd before = calcUnits();
  for (Index c = 0; c < model_.conditions; ++c) {
    const double value = measurement.conditions[c];
    if (!std::isfinite(value)) {
      continue;
    }
    state_.condition_counts[c] += 1.0;
    if (state_.condition_counts[c] == 1.0) {
      state_.reference[c] = value;
      continue;
    }
    const double off = value - state_.reference[c];
    state_.spread[c] += (off * off - state_.spread[c]) / (state_.condition_counts[c] - 1.0);
  }
  setUnits(before);
}

void Tracker::noteVariances(const Measurement& measurement) {
  if (measurement.values.size() == 0) {
    return;
  }
  ++state_.informed;
  for (Index j = 0; j < model_.countParameters(); ++j) {
    const double prior = model_.covariance(j, j), own = measurement.variances[j];
    const double variance = std::isfinite(own) ? std::min(own, prior) : prior;
    state_.variances[j] += (variance - state_.variances[j]) / static_cast<double>(state_.informed);
  }
}

void Tracker::moveTo(double time) {
  const double dt = state_.count > 0 ? time - state_.time : 0.0;
  if (dt > 0.0 && state_.interval == 0.0) {
    const VectorXd before = calcUnits();
    state_.interval = dt;
    setUnits(before);
  }
  const VectorXd growth = dt * calcRates(kAbove);
  predict(model_, dt, growth, state_.belief);
  for (RateFilters& filters : state_.filters) {
    VectorXd own = growth;
    for (int g = 0; g < kRates; ++g) {
      const double ratio = getRateRatio(g);
      own[filters.parameter] = ratio * ratio * calcUnitRate(filters.parameter) * dt;
      predict(model_, dt, own, filters.beliefs[static_cast<std::size_t>(g)]);
    }
  }
  VectorXd stddev(model_.countParameters());
  for (Index j = 0; j < stddev.size(); ++j) {
    constexpr double kUnknownSize = 3.0;  // measurements' standard deviations
    const double stated = model_.drifts[static_cast<std::size_t>(j)].change_stddev;
    stddev[j] = stated > 0.0 ? stated : kUnknownSize * std::sqrt(state_.variances[j]);
  }
  supposeChanges(model_, dt, time, stddev, collectLogWeights(state_.filters), state_.changes);
  state_.time = time;
  ++state_.count;
}

void Tracker::take(const StateRows& rows, const Belief& updated) {
  state_.belief = updated;
  for (RateFilters& filters : state_.filters) {
    for (int g = 0; g < kRates; ++g) {
      filters.log_weights[g] += update(rows, filters.beliefs[static_cast<std::size_t>(g)]);
    }
    filters.log_weights.array() -= filters.log_weights.maxCoeff();
  }
}

Step Tracker::advance(const Measurement& said) {
  moveTo(said.time);
  noteConditions(said);
  Step step;
  step.taken = resolveModes(model_, said, state_.reference, state_.belief);
  const Measurement& measurement = step.taken;
  noteVariances(measurement);
  const StateRows rows = makeStateRows(model_, measurement, state_.reference, state_.spread, state_.belief);
  std::vector<Innovation> innovations(static_cast<std::size_t>(measurement.values.size()));
  Belief updated = state_.belief;
  update(rows, updated, &innovations);
  step.degrees = static_cast<double>(innovations.size());
  for (const Innovation& innovation : innovations) {
    step.chi_square += innovation.value * innovation.value / innovation.variance;
  }
  const double log_bad = innovations.empty() ? -kNever : calcLogBad(step.chi_square, step.degrees);
  step.is_used = !innovations.empty() && log_bad < 0.0;
  if (step.is_used) {
    take(rows, updated);
  }
  weighChanges({rows, innovations, log_bad, step.is_used, model_.countParameters()}, state_.changes);
  const double threshold = calcThreshold(model_, calcRatios());
  step.statistic = calcShiryaevRoberts(model_, state_.changes) / threshold;
  if (!innovations.empty()) {
    state_.run_of_bad = step.is_used ? 0 : state_.run_of_bad + 1;
    state_.surprises += (step.is_used ? 0.0 : 1.0) - state_.surprises / kMemory;
  }
  if (step.statistic >= 1.0) {
    step.change = describeChange(model_, threshold, state_.changes);
    confirm(*step.change, step.statistic);
  } else if (state_.run_of_bad == kRunOfBad) {
    step.has_begun_anew = true;
    beginAnew();
  }
  step.is_uncalibrated = widenRates();
  return step;
}

/// Known rates become larger, unknown ones are learnt anew, where even changes do not explain measurements.
bool Tracker::widenRates() {
  constexpr double kWider = 4.0;
  if (state_.surprises <= kSurprises) {
    return false;
  }
  state_.widening *= kWider;
  state_.surprises = 0.0;
  for (RateFilters& filters : state_.filters) {
    filters.log_weights = makeLogRatePrior();
  }
  return true;
}

/// Levels as little known as before the first measurement; slopes, coefficients and rates as they are.
void Tracker::beginAnew() {
  const Index p = model_.countParameters();
  visitBeliefs(state_, [&](Belief& belief) { belief.covariance.topLeftCorner(p, p) += model_.covariance; });
  state_.changes = {};
  state_.run_of_bad = 0;
}

/// log of a mixture of two distributions that are known but for a factor.
VectorXd mix(const VectorXd& log_one, const VectorXd& log_other, double share_of_one) {
  const auto normalize = [](const VectorXd& log) -> Eigen::ArrayXd {
    const Eigen::ArrayXd weights = (log.array() - log.maxCoeff()).exp();
    return weights / weights.sum();
  };
  const Eigen::ArrayXd mixed =
      share_of_one * normalize(log_one) + (1.0 - share_of_one) * normalize(log_other);
  return (mixed / mixed.maxCoeff()).max(1e-300).log();
}

/// What is believed becomes a mixture of the changes that are supposed and of none. Odds are even at the
/// threshold, where an alarm is as likely false as true. Rates are as before the likeliest change, or as
/// without any.
void Tracker::confirm(const Change& change, double odds) {
  const double probability = odds / (1.0 + odds);
  addChanges(probability * calcChangeShares(model_, state_.changes), state_.changes, state_.belief);
  const MatrixXd log_weights =
      state_.changes.log_weights[change.place / static_cast<std::size_t>(model_.countParameters())];
  for (std::size_t u = 0; u < state_.filters.size(); ++u) {
    RateFilters& filters = state_.filters[u];
    filters.log_weights = mix(log_weights.col(static_cast<Index>(u)), filters.log_weights, probability);
    std::fill(filters.beliefs.begin(), filters.beliefs.end(), state_.belief);
  }
  state_.changes = {};
  state_.run_of_bad = 0;
}

Belief Tracker::calcBelief() const {
  Belief belief = state_.belief;
  for (const RateFilters& filters : state_.filters) {
    const Index j = filters.parameter;
    const Moments moments = calcMoments(filters, calcRatePosterior(filters));
    const double scale = std::sqrt(moments.variance / belief.covariance(j, j));
    belief.mean[j] = moments.mean;
    belief.covariance.row(j) *= scale;
    belief.covariance.col(j) *= scale;
  }
  belief.covariance.diagonal().head(model_.countParameters()) += calcSharedVariances();
  return belief;
}

VectorXd Tracker::calcSharedVariances() const {
  return VectorXd::NullaryExpr(model_.countParameters(), [&](Index j) {
    const double share = model_.drifts[static_cast<std::size_t>(j)].shared_error;
    return share > 0.0 ? share * share * state_.variances[j] : 0.0;
  });
}

}  // namespace twinmap::tracking
