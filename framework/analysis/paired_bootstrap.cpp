#include "framework/analysis/paired_bootstrap.hpp"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cassert>
#include <cmath>
#include <limits>

#include "framework/base/random/random.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kBlock = 64;  // resamples whose means are one matrix product

VectorXd calcAtMeans(const TermSet& set) {
  return set.figures(set.terms.rowwise().mean(), static_cast<double>(set.terms.cols()));
}

/// Column r: how often resample first + r of stream `stream` draws each of n samples, over n.
MatrixXd drawWeights(const RandomStream& random, Index n, int first, int count, int stream) {
  MatrixXd weights = MatrixXd::Zero(n, count);
  for (int r = 0; r < count; ++r) {
    for (Index i = 0; i < n; ++i) {
      const double uniform = random.calcUniform(first + r, i, stream);
      weights(std::min(static_cast<Index>(uniform * static_cast<double>(n)), n - 1), r) += 1.0;
    }
  }
  return weights / static_cast<double>(n);
}

/// Figures of each resample, one column each.
MatrixXd calcResampled(const TermSet& set, const MatrixXd& weights) {
  const MatrixXd means = set.terms * weights;
  MatrixXd figures(calcAtMeans(set).size(), means.cols());
  for (Index r = 0; r < means.cols(); ++r) {
    figures.col(r) = set.figures(means.col(r), static_cast<double>(set.terms.cols()));
  }
  return figures;
}

/// Differences of the figures of all resamples, one column each; `stream_b` is that of a for pairs.
MatrixXd calcResampledDifferences(const TermSet& a, const TermSet& b, const BootstrapOptions& options,
                                  int stream_b) {
  const RandomStream random(options.seed, RandomPurpose::kBootstrap);
  MatrixXd differences(calcAtMeans(a).size(), options.resamples);
  for (int first = 0; first < options.resamples; first += kBlock) {
    const int count = std::min(kBlock, options.resamples - first);
    const MatrixXd weights_a = drawWeights(random, a.terms.cols(), first, count, 0);
    const MatrixXd weights_b =
        stream_b == 0 ? weights_a : drawWeights(random, b.terms.cols(), first, count, stream_b);
    differences.middleCols(first, count) = calcResampled(b, weights_b) - calcResampled(a, weights_a);
  }
  return differences;
}

/// How the figures respond to each sample: mean over i of f_i, minus f_i, times (n - 1) / n, with f_i the
/// figures without sample i; one column a sample.
MatrixXd calcInfluences(const TermSet& set) {
  const auto n = static_cast<double>(set.terms.cols());
  const VectorXd mean = set.terms.rowwise().mean();
  MatrixXd without(calcAtMeans(set).size(), set.terms.cols());
  for (Index i = 0; i < set.terms.cols(); ++i) {
    without.col(i) = set.figures(mean + (mean - set.terms.col(i)) / (n - 1.0), n - 1.0);
  }
  const VectorXd center = without.rowwise().mean();
  return (n - 1.0) / n * ((-without).colwise() + center);
}

/// a, from influences of one figure.
double calcAcceleration(const Eigen::ArrayXd& influences) {
  const double variance = influences.square().sum();
  return variance > 0.0 ? influences.cube().sum() / (6.0 * std::pow(variance, 1.5)) : 0.0;
}

double calcQuantile(const VectorXd& sorted, double probability) {
  const auto last = static_cast<double>(sorted.size() - 1);
  const double place = std::clamp(probability * (last + 2.0) - 1.0, 0.0, last);
  const auto below = static_cast<Index>(place);
  const Index above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (place - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

/// G(value), a tie counting half, kept off 0 and 1.
double calcRank(const VectorXd& sorted, double value) {
  const auto below = std::lower_bound(sorted.begin(), sorted.end(), value) - sorted.begin();
  const auto up_to = std::upper_bound(sorted.begin(), sorted.end(), value) - sorted.begin();
  const auto n = static_cast<double>(sorted.size());
  return std::clamp(0.5 * static_cast<double>(below + up_to) / n, 0.5 / n, 1.0 - 0.5 / n);
}

/// Where BCa reads the resampled distribution for the limit at `probability`.
double correctProbability(double probability, double bias, double acceleration) {
  const boost::math::normal normal;
  const double z = bias + boost::math::quantile(normal, probability);
  return boost::math::cdf(normal, bias + z / (1.0 - acceleration * z));
}

struct Limits {
  double lower, upper;
};

Limits calcLimits(VectorXd resampled, double value, double acceleration, double probability) {
  if (!resampled.allFinite() || !std::isfinite(value)) {
    const double unknown = std::numeric_limits<double>::quiet_NaN();
    return {unknown, unknown};
  }
  std::sort(resampled.begin(), resampled.end());
  const double bias = boost::math::quantile(boost::math::normal(), calcRank(resampled, value));
  const double tail = 0.5 * (1.0 - probability);
  return {calcQuantile(resampled, correctProbability(tail, bias, acceleration)),
          calcQuantile(resampled, correctProbability(1.0 - tail, bias, acceleration))};
}

DifferenceIntervals makeIntervals(const TermSet& a, const TermSet& b, const MatrixXd& resampled,
                                  const MatrixXd& influences, double probability) {
  DifferenceIntervals intervals;
  intervals.difference = calcAtMeans(b) - calcAtMeans(a);
  intervals.lower = intervals.upper = intervals.difference;
  for (Index f = 0; f < intervals.difference.size(); ++f) {
    const Limits limits = calcLimits(resampled.row(f), intervals.difference[f],
                                     calcAcceleration(influences.row(f).transpose()), probability);
    intervals.lower[f] = limits.lower;
    intervals.upper[f] = limits.upper;
  }
  return intervals;
}

}  // namespace

DifferenceIntervals calcPairedIntervals(const TermSet& a, const TermSet& b, const BootstrapOptions& options) {
  assert(a.terms.cols() == b.terms.cols());
  return makeIntervals(a, b, calcResampledDifferences(a, b, options, 0),
                       calcInfluences(b) - calcInfluences(a), options.probability);
}

DifferenceIntervals calcUnpairedIntervals(const TermSet& a, const TermSet& b,
                                          const BootstrapOptions& options) {
  const MatrixXd of_a = calcInfluences(a), of_b = calcInfluences(b);
  MatrixXd influences(of_a.rows(), of_a.cols() + of_b.cols());
  influences << -of_a, of_b;
  return makeIntervals(a, b, calcResampledDifferences(a, b, options, 1), influences, options.probability);
}

}  // namespace twinmap
