#include "kernels/tracking/change_bank.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "kernels/tracking/log_product.hpp"

namespace twinmap::tracking {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

double calcTotalWeight(const Model& model) {
  double total = 0.0;
  for (const Drift& drift : model.drifts) {
    total += drift.change_weight;
  }
  return total;
}

/// Of each supposed change, its share of the statistic, over that of the largest.
VectorXd calcShares(const Model& model, const ChangeBank& bank, double largest) {
  VectorXd shares(static_cast<Index>(bank.changes.size()));
  for (std::size_t c = 0; c < bank.changes.size(); ++c) {
    const Supposed& change = bank.changes[c];
    shares[static_cast<Index>(c)] = model.drifts[static_cast<std::size_t>(change.parameter)].change_weight *
                                    std::exp(change.log_ratio - largest);
  }
  return shares;
}

double findLargest(const ChangeBank& bank) {
  double largest = 0.0;
  for (const Supposed& change : bank.changes) {
    largest = std::max(largest, change.log_ratio);
  }
  return largest;
}

void moveSignature(const Model& model, double dt, VectorXd& signature) {
  Index slope = model.countParameters();
  for (Index j = 0; j < model.countParameters(); ++j) {
    if (model.drifts[static_cast<std::size_t>(j)].has_slope) {
      signature[j] += dt * signature[slope++];
    }
  }
}

}  // namespace

void supposeChanges(const Model& model, double dt, double time, const VectorXd& stddev,
                    const Eigen::MatrixXd& log_weights, ChangeBank& bank) {
  const auto p = static_cast<std::size_t>(model.countParameters());
  for (Supposed& change : bank.changes) {
    moveSignature(model, dt, change.signature);
  }
  if (bank.changes.size() == kChangeWindow * p) {
    bank.changes.erase(bank.changes.begin(), bank.changes.begin() + static_cast<std::ptrdiff_t>(p));
    bank.log_weights.erase(bank.log_weights.begin());
  }
  bank.log_weights.push_back(log_weights);
  for (std::size_t j = 0; j < p; ++j) {
    const auto parameter = static_cast<Index>(j);
    bank.changes.push_back({parameter, time, VectorXd::Unit(model.countStates(), parameter), 0.0,
                            stddev[parameter] * stddev[parameter], 0.0});
  }
}

namespace {

/// A change of a measurement ago may be of any size: its prior is as wide as that one says at least.
void widen(const ChangeEvidence& evidence, Supposed& change, VectorXd& signature) {
  signature = change.signature;
  double descent = 0.0, information = 0.0;
  for (std::size_t i = 0; i < evidence.innovations.size(); ++i) {
    const Innovation& innovation = evidence.innovations[i];
    const double seen = evidence.rows.rows.col(static_cast<Index>(i)).dot(signature);
    descent += seen * innovation.value / innovation.variance;
    information += seen * seen / innovation.variance;
    signature -= seen * innovation.gain;
  }
  if (information > 0.0) {
    const double size = descent / information;
    change.variance = std::max(change.variance, size * size);
  }
}

/// What a measurement is without any change.
struct Unchanged {
  double chi_square = 0.0, log_variances = 0.0;  ///< of its innovations
  double log_density = 0.0;                      ///< with the bad ones, over that of a good one
};

Unchanged describeUnchanged(const ChangeEvidence& evidence) {
  Unchanged unchanged;
  LogProduct variances;
  for (const Innovation& innovation : evidence.innovations) {
    unchanged.chi_square += innovation.value * innovation.value / innovation.variance;
    variances.multiply(innovation.variance);
  }
  unchanged.log_variances = variances.calc();
  unchanged.log_density = std::max(0.0, evidence.log_bad) + std::log1p(std::exp(-std::abs(evidence.log_bad)));
  return unchanged;
}

/// One supposed change, a measurement later.
void weigh(const ChangeEvidence& evidence, const Unchanged& unchanged, Supposed& change,
           VectorXd& signature) {
  double size = change.size, variance = change.variance, chi_square = 0.0;
  LogProduct variances;
  signature = change.signature;
  for (std::size_t i = 0; i < evidence.innovations.size(); ++i) {
    const Innovation& innovation = evidence.innovations[i];
    const double seen = evidence.rows.rows.col(static_cast<Index>(i)).dot(signature);
    const double with = innovation.variance + seen * seen * variance;
    const double off = innovation.value - seen * size, share = off / with;
    chi_square += off * share;
    variances.multiply(with);
    size += variance * seen * share;
    variance *= innovation.variance / with;
    signature -= seen * innovation.gain;
  }
  const double log_good =
      0.5 * (unchanged.chi_square - chi_square - (variances.calc() - unchanged.log_variances));
  const double larger = std::max(log_good, evidence.log_bad);
  change.log_ratio +=
      larger + std::log1p(std::exp(std::min(log_good, evidence.log_bad) - larger)) - unchanged.log_density;
  if (log_good > evidence.log_bad) {
    change.size = size;
    change.variance = variance;
  }
  if (evidence.is_used) {
    change.signature = signature;
  }
}

}  // namespace

void weighChanges(const ChangeEvidence& evidence, ChangeBank& bank) {
  // log(2): with 20, one in twenty bad measurements raise half as many alarms again at rates of .3, and steps
  // are found no sooner (docs/benchmarks/tracking.md)
  constexpr double kAlone = 0.7;
  const Unchanged unchanged = describeUnchanged(evidence);
  VectorXd signature(evidence.rows.rows.rows());
  for (Supposed& change : bank.changes) {
    const bool is_new = &bank.changes.back() - &change < evidence.parameters;
    if (is_new) {
      widen(evidence, change, signature);
    }
    weigh(evidence, unchanged, change, signature);
    if (is_new) {  // one measurement alone may be bad in any way: it counts for no more than that is rare
      change.log_ratio = std::min(change.log_ratio, kAlone);
    }
  }
}

double calcShiryaevRoberts(const Model& model, const ChangeBank& bank) {
  const double largest = findLargest(bank);
  return std::exp(largest) * calcShares(model, bank, largest).sum() / calcTotalWeight(model);
}

namespace {

// log of the thresholds at which lives without a change raise .85 of the alarms that are stated, so that one
// in twenty measurements may be bad (docs/benchmarks/tracking.md). Rows: ratios 0, .1, .316 and 1; columns: 1
// in 100, 1000 and 10000. They do not depend on the number of parameters.
constexpr std::size_t kRatioCount = kRatioPlaces.size(), kLevelCount = 3;
using Thresholds = std::array<std::array<double, kLevelCount>, kRatioCount>;
constexpr Thresholds kOfKnown{{{26.5, 195, 1610}, {27, 141, 850}, {28.5, 76, 340}, {33.5, 47, 200}}};
constexpr Thresholds kOfUnknown{{{16.5, 50, 165}, {20, 82, 590}, {26.5, 64, 340}, {32.5, 48, 400}}};

double calcLogThreshold(const std::array<double, kLevelCount>& of_levels, double decade) {
  const std::size_t below = decade < 1.0 ? 0 : 1;
  const double first = std::log(of_levels[below]), second = std::log(of_levels[below + 1]);
  return first + (second - first) * (decade - static_cast<double>(below));
}

/// decade: 0 of 1 in 100, 1 of 1 in 1000.
double calcThreshold(const Thresholds& thresholds, double ratio, double decade) {
  const double place = std::min(ratio / (ratio + kSlowRatio), kRatioPlaces.back());
  std::size_t below = 0;
  while (below + 2 < kRatioCount && kRatioPlaces[below + 1] < place) {
    ++below;
  }
  const double share = (place - kRatioPlaces[below]) / (kRatioPlaces[below + 1] - kRatioPlaces[below]);
  return std::exp((1.0 - share) * calcLogThreshold(thresholds[below], decade) +
                  share * calcLogThreshold(thresholds[below + 1], decade));
}

}  // namespace

double calcThreshold(const Model& model, const VectorXd& ratios) {
  const double decade = std::log10(1e-2 / model.false_alarms);
  double sum = 0.0;
  for (std::size_t j = 0; j < model.drifts.size(); ++j) {
    const Thresholds& thresholds = std::isnan(model.drifts[j].rate) ? kOfUnknown : kOfKnown;
    sum += model.drifts[j].change_weight * calcThreshold(thresholds, ratios[static_cast<Index>(j)], decade);
  }
  return sum / calcTotalWeight(model);
}

VectorXd calcChangeShares(const Model& model, const ChangeBank& bank) {
  const VectorXd shares = calcShares(model, bank, findLargest(bank));
  return shares / shares.sum();
}

void addChanges(const VectorXd& probabilities, const ChangeBank& bank, Belief& belief) {
  VectorXd mean = VectorXd::Zero(belief.mean.size());
  for (std::size_t c = 0; c < bank.changes.size(); ++c) {
    mean += probabilities[static_cast<Index>(c)] * bank.changes[c].size * bank.changes[c].signature;
  }
  belief.covariance += (1.0 - probabilities.sum()) * mean * mean.transpose();
  for (std::size_t c = 0; c < bank.changes.size(); ++c) {
    const Supposed& change = bank.changes[c];
    const VectorXd off = change.size * change.signature - mean;
    belief.covariance +=
        probabilities[static_cast<Index>(c)] *
        (change.variance * change.signature * change.signature.transpose() + off * off.transpose());
  }
  belief.mean += mean;
}

Change describeChange(const Model& model, double threshold, const ChangeBank& bank) {
  const VectorXd shares = calcChangeShares(model, bank);
  Change described;
  described.probabilities = VectorXd::Zero(model.countParameters());
  for (std::size_t c = 0; c < bank.changes.size(); ++c) {
    described.probabilities[bank.changes[c].parameter] += shares[static_cast<Index>(c)];
  }
  described.probability = described.probabilities.maxCoeff(&described.parameter);
  double best = -1.0, sum = 0.0;
  described.earliest = described.latest = bank.changes.back().time;
  bool has_begun = false;
  for (std::size_t c = 0; c < bank.changes.size(); ++c) {
    const Supposed& change = bank.changes[c];
    const double share = shares[static_cast<Index>(c)];
    if (change.parameter != described.parameter) {
      continue;
    }
    if (share > best) {
      best = share;
      described.place = c;
    }
    sum += share / described.probability;
    if (!has_begun && sum >= 0.025) {
      described.earliest = change.time;
      has_begun = true;
    }
    if (sum <= 0.975) {
      described.latest = change.time;
    }
  }
  const Supposed& change = bank.changes[described.place];
  described.log_prior_odds = -std::log(threshold * best);
  described.time = change.time;
  described.latest = std::max(described.latest, change.time);
  described.size = change.size;
  described.stddev = std::sqrt(change.variance);
  return described;
}

}  // namespace twinmap::tracking
