#include "framework/estimation/mixture.hpp"

#include <algorithm>
#include <boost/math/constants/constants.hpp>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <limits>

#include "kernels/linalg/decompositions.hpp"

namespace twinmap {
namespace {

using Eigen::ArrayXd;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
namespace constants = boost::math::constants;

double calcNormalDensity(double z) {
  return std::exp(-0.5 * z * z) * constants::one_div_root_two_pi<double>();
}

double calcNormalProbability(double z) {
  return 0.5 * std::erfc(-z * constants::one_div_root_two<double>());
}

/// Values between which the density is monotonous, or nearly: those of every component's own scale.
std::vector<double> listScale(const MarginalMixture& marginal) {
  constexpr double kReach = 10.0, kStep = 0.1;  // standard deviations
  std::vector<double> values;
  for (Index c = 0; c < marginal.weights.size(); ++c) {
    for (double at = -kReach; at <= kReach; at += kStep) {
      values.push_back(marginal.means[c] + at * marginal.stddevs[c]);
    }
  }
  std::sort(values.begin(), values.end());
  return values;
}

/// Where the density is above one level or another: at the values of listScale() it is known.
class LevelSets {
 public:
  explicit LevelSets(const MarginalMixture& marginal)
      : marginal_(marginal), values_(listScale(marginal)), densities_(values_.size()) {
    for (std::size_t i = 0; i < values_.size(); ++i) {
      densities_[i] = marginal.calcDensity(values_[i]);
    }
  }

  double getHighest() const { return *std::max_element(densities_.begin(), densities_.end()); }

  Intervals findAbove(double level) const {
    Intervals intervals;
    bool was_above = densities_.front() > level;
    double begin = values_.front();
    for (std::size_t i = 1; i < values_.size(); ++i) {
      const bool is_above = densities_[i] > level;
      if (is_above && !was_above) {
        begin = findCrossing(level, values_[i - 1], values_[i]);
      } else if (was_above && !is_above) {
        intervals.emplace_back(begin, findCrossing(level, values_[i], values_[i - 1]));
      }
      was_above = is_above;
    }
    if (was_above) {
      intervals.emplace_back(begin, values_.back());
    }
    return intervals;
  }

 private:
  /// Between values on either side of the level, on the side above it.
  double findCrossing(double level, double below, double above) const {
    const double exact =
        std::numeric_limits<double>::epsilon() * (std::abs(values_.back()) + std::abs(values_.front()));
    while (std::abs(above - below) > exact) {
      const double middle = 0.5 * (below + above);
      (marginal_.calcDensity(middle) > level ? above : below) = middle;
    }
    return above;
  }

  const MarginalMixture& marginal_;
  std::vector<double> values_, densities_;
};

double calcProbability(const MarginalMixture& marginal, const Intervals& intervals) {
  double probability = 0.0;
  for (const auto& [lower, upper] : intervals) {
    probability += marginal.calcProbability(upper) - marginal.calcProbability(lower);
  }
  return probability;
}

/// E|X| of a normal distribution.
double calcMeanAbsolute(double mean, double stddev) {
  const double z = mean / stddev;
  return mean * (2.0 * calcNormalProbability(z) - 1.0) + 2.0 * stddev * calcNormalDensity(z);
}

}  // namespace

VectorXd calcMean(const Mixture& mixture) {
  return mixture.means * mixture.weights;
}

MatrixXd calcCovariance(const Mixture& mixture) {
  const MatrixXd apart = mixture.means.colwise() - calcMean(mixture);
  MatrixXd covariance = apart * mixture.weights.asDiagonal() * apart.transpose();
  for (Index c = 0; c < mixture.countComponents(); ++c) {
    const auto stddev = mixture.stddevs.col(c);
    covariance +=
        mixture.weights[c] *
        (stddev.asDiagonal() * mixture.correlations[static_cast<std::size_t>(c)] * stddev.asDiagonal());
  }
  return covariance;
}

void convert(const VectorXd& center, const VectorXd& unit, const VectorXd& stddev_scale, Mixture& mixture) {
  mixture.means = (unit.asDiagonal() * mixture.means).colwise() + center;
  mixture.stddevs = stddev_scale.cwiseProduct(unit).asDiagonal() * mixture.stddevs;
}

void shrinkToBounds(const VectorXd& center, const VectorXd& half_width, const VectorXd& stddev,
                    Mixture& mixture) {
  const VectorXd factor = half_width.cwiseQuotient(stddev).cwiseMin(1.0);
  convert(center - factor.cwiseProduct(center), factor, VectorXd::Ones(center.size()), mixture);
}

Mixture takeFirst(const Mixture& mixture, Index p) {
  Mixture first{mixture.weights, mixture.means.topRows(p), mixture.stddevs.topRows(p), {}};
  for (const MatrixXd& correlation : mixture.correlations) {
    first.correlations.push_back(correlation.topLeftCorner(p, p));
  }
  return first;
}

Index findLikeliest(const Mixture& mixture) {
  const MixtureDensity mixed(mixture);
  Index best = 0;
  double highest = -std::numeric_limits<double>::infinity();
  for (Index c = 0; c < mixture.countComponents(); ++c) {
    const double density = mixed.calcLog(mixture.means.col(c));
    if (density > highest) {
      highest = density;
      best = c;
    }
  }
  return best;
}

MixtureDensity::MixtureDensity(const Mixture& mixture)
    : mixture_(mixture), offsets_(mixture.countComponents()) {
  const double log_root_two_pi = 0.5 * std::log(constants::two_pi<double>());
  for (Index c = 0; c < mixture.countComponents(); ++c) {
    const MatrixXd lower = mixture.stddevs.col(c).asDiagonal() *
                           linalg::calcCholesky(mixture.correlations[static_cast<std::size_t>(c)]).lower;
    offsets_[c] = std::log(mixture.weights[c]) - static_cast<double>(lower.rows()) * log_root_two_pi -
                  lower.diagonal().array().log().sum();
    factors_.push_back(lower);
  }
}

double MixtureDensity::calcLog(const Eigen::Ref<const VectorXd>& point) const {
  VectorXd densities = offsets_;
  for (Index c = 0; c < densities.size(); ++c) {
    const MatrixXd apart = point - mixture_.means.col(c);
    densities[c] -= 0.5 * linalg::solveLower(factors_[static_cast<std::size_t>(c)], apart).squaredNorm();
  }
  const double largest = densities.maxCoeff();
  return largest + std::log((densities.array() - largest).exp().sum());
}

double MarginalMixture::calcDensity(double value) const {
  double density = 0.0;
  for (Index c = 0; c < weights.size(); ++c) {
    density += weights[c] / stddevs[c] * calcNormalDensity((value - means[c]) / stddevs[c]);
  }
  return density;
}

double MarginalMixture::calcProbability(double value) const {
  double probability = 0.0;
  for (Index c = 0; c < weights.size(); ++c) {
    probability += weights[c] * calcNormalProbability((value - means[c]) / stddevs[c]);
  }
  return probability;
}

MarginalMixture takeMarginal(const Mixture& mixture, Index parameter) {
  return {mixture.weights, mixture.means.row(parameter), mixture.stddevs.row(parameter)};
}

std::vector<MarginalMixture> takeMarginals(const std::vector<Mixture>& mixtures, Index parameter) {
  std::vector<MarginalMixture> marginals;
  for (const Mixture& mixture : mixtures) {
    marginals.push_back(takeMarginal(mixture, parameter));
  }
  return marginals;
}

Intervals findAbove(const MarginalMixture& marginal, double level) {
  return LevelSets(marginal).findAbove(level);
}

Intervals findHighestDensity(const MarginalMixture& marginal, double probability) {
  const LevelSets sets(marginal);
  double below = 0.0, above = sets.getHighest();
  while (above - below > std::numeric_limits<double>::epsilon() * sets.getHighest()) {
    const double middle = 0.5 * (below + above);
    const double found = calcProbability(marginal, sets.findAbove(middle));
    (found > probability ? below : above) = middle;
  }
  return sets.findAbove(below);
}

Intervals findWithin(const MarginalMixture& marginal, double depth) {
  return findHighestDensity(marginal, std::erf(depth * constants::one_div_root_two<double>()));
}

bool isMultimodal(const MarginalMixture& marginal) {
  return findHighestDensity(marginal, 0.95).size() > 1;
}

bool isMultimodal(const Mixture& mixture) {
  for (Index p = 0; p < mixture.means.rows(); ++p) {
    if (isMultimodal(takeMarginal(mixture, p))) {
      return true;
    }
  }
  return false;
}

double calcCredibility(const MarginalMixture& marginal, double value) {
  const double level = marginal.calcDensity(value);
  return level > 0.0 ? std::min(1.0, calcProbability(marginal, findAbove(marginal, level))) : 1.0;
}

double calcDepth(const MarginalMixture& marginal, double value) {
  // so that half of it and 1 is below 1
  const double largest = 1.0 - 4.0 * std::numeric_limits<double>::epsilon();
  const double credibility = std::min(calcCredibility(marginal, value), largest);
  return boost::math::quantile(boost::math::normal(), 0.5 * (1.0 + credibility));
}

double calcCrps(const MarginalMixture& marginal, double truth) {
  double distance = 0.0, spread = 0.0;
  for (Index i = 0; i < marginal.weights.size(); ++i) {
    distance += marginal.weights[i] * calcMeanAbsolute(truth - marginal.means[i], marginal.stddevs[i]);
    for (Index j = 0; j < marginal.weights.size(); ++j) {
      spread += marginal.weights[i] * marginal.weights[j] *
                calcMeanAbsolute(marginal.means[i] - marginal.means[j],
                                 std::hypot(marginal.stddevs[i], marginal.stddevs[j]));
    }
  }
  return distance - 0.5 * spread;
}

}  // namespace twinmap
