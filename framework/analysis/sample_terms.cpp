#include "framework/analysis/sample_terms.hpp"

#include <boost/math/constants/constants.hpp>
#include <cmath>

#include "framework/analysis/calibration.hpp"

namespace twinmap {
namespace {

using Eigen::ArrayXd;
using Eigen::Index;
using Eigen::VectorXd;

/// Rows of SampleTerms::terms.
enum Term : Index {
  kError,
  kSquaredError,
  kAbsoluteError,
  kWithin95,
  kWithin90,
  kWithin50,
  kClaimedVariance,
  kZ,
  kSquaredZ,
  kSurprise,
  kCrps,
  kSquaredLimit,
  kLimitSurprise,
  kTerms
};

const double kLogRootTwoPi = 0.5 * std::log(boost::math::constants::two_pi<double>());

ArrayXd calcWithin(const ArrayXd& depth, double probability) {
  return (depth < calcTwoSidedQuantile(probability)).cast<double>();
}

/// How the truths lie in what is said of them.
struct Scores {
  ArrayXd z;
  ArrayXd depth;     ///< the two-sided normal quantile of the smallest interval that holds the truth
  ArrayXd surprise;  ///< negative logarithmic density
  ArrayXd crps;
};

Scores scoreNormal(const ParameterSamples& samples) {
  const ArrayXd error = (samples.mean - samples.truth) / samples.stddev;
  const ArrayXd z = samples.z.size() > 0 ? samples.z : error;
  return {z, z.abs(), 0.5 * z.square() + samples.stddev.log() + kLogRootTwoPi,
          calcCrps(error, samples.stddev)};
}

Scores scoreMixtures(const ParameterSamples& samples) {
  const Index n = samples.truth.size();
  Scores scores{ArrayXd(n), ArrayXd(n), ArrayXd(n), ArrayXd(n)};
  for (Index i = 0; i < n; ++i) {
    const MarginalMixture& marginal = samples.mixtures[static_cast<std::size_t>(i)];
    const double truth = samples.truth[i];
    scores.z[i] = -calcNormalQuantile(marginal.calcProbability(truth));
    scores.depth[i] = calcDepth(marginal, truth);
    scores.surprise[i] = -std::log(marginal.calcDensity(truth));
    scores.crps[i] = calcCrps(marginal, truth);
  }
  return scores;
}

/// Depths as a normal distribution's, which has intervals of the same probability.
ArrayXd toNormal(const std::vector<IntervalFactor>& factors, ArrayXd depths) {
  for (std::size_t i = 0; i < factors.size(); ++i) {
    double& depth = depths[static_cast<Index>(i)];
    depth = factors[i].calcEquivalentZ(depth);
  }
  return depths;
}

ArrayXd calcScale(const ParameterSpec& parameter, const ArrayXd& truth) {
  if (isRelativeToRange(parameter)) {
    return ArrayXd::Constant(truth.size(), parameter.bounds.upper - parameter.bounds.lower);
  }
  return truth;
}

/// From means of values and of their squares, with 1/(n-1).
double calcStddev(double mean, double mean_square, double samples) {
  return std::sqrt(std::max(0.0, mean_square - mean * mean) * samples / (samples - 1.0));
}

ParameterFigures calcFigures(const SampleTerms& offsets, const VectorXd& mean, double samples) {
  constexpr double kPercent = 100.0;
  ParameterFigures figures;
  figures.bias_pct = kPercent * (offsets.error_offset + mean[kError]);
  figures.sd_pct = kPercent * calcStddev(mean[kError], mean[kSquaredError], samples);
  figures.mare_pct = kPercent * mean[kAbsoluteError];
  figures.coverage95 = mean[kWithin95];
  figures.coverage90 = mean[kWithin90];
  figures.coverage50 = mean[kWithin50];
  figures.stddev_pct = kPercent * std::sqrt(mean[kClaimedVariance]);
  figures.z_mean = offsets.z_offset + mean[kZ];
  figures.z_sd = calcStddev(mean[kZ], mean[kSquaredZ], samples);
  figures.nlpd = mean[kSurprise];
  figures.crps_pct = kPercent * mean[kCrps];
  figures.limit_pct = kPercent * std::sqrt(mean[kSquaredLimit]);
  figures.ratio_to_limit = figures.sd_pct / figures.limit_pct;
  figures.nats_above_limit = mean[kSurprise] - mean[kLimitSurprise];
  return figures;
}

VectorXd toVector(const ParameterFigures& figures) {
  VectorXd values(kFigureColumns.size());
  for (std::size_t i = 0; i < kFigureColumns.size(); ++i) {
    values[static_cast<Index>(i)] = figures.*kFigureColumns[i].value;
  }
  return values;
}

}  // namespace

Eigen::MatrixXd sumUp(const Eigen::MatrixXd& terms, const VectorXd& weights,
                      const std::vector<Index>& repeated) {
  if (weights.size() == 0) {
    return terms;
  }
  const Index n = terms.cols() - static_cast<Index>(repeated.size());
  Eigen::MatrixXd weighted = terms;
  for (Index i = 0; i < terms.cols(); ++i) {
    if (weights[i] == 0.0) {
      weighted.col(i).setZero();  // also of an infinite term
    }
  }
  const VectorXd mean = weighted * weights / weights.sum();
  weighted = ((weighted.colwise() - mean) * weights.asDiagonal()).eval();
  Eigen::MatrixXd sums = weighted.leftCols(n);
  for (std::size_t k = 0; k < repeated.size(); ++k) {
    sums.col(repeated[k]) += weighted.col(n + static_cast<Index>(k));
  }
  return (static_cast<double>(n) / weights.sum() * sums).colwise() + mean;
}

ParameterSamples takeParameter(const Eigen::MatrixXd& truth, const Estimates& predictions,
                               const Eigen::MatrixXd& limit_stddev, Index row) {
  const ArrayXd unknown = ArrayXd::Constant(predictions.mean.cols(), std::nan(""));
  return {predictions.repeat(truth.row(row)).transpose(),
          predictions.mean.row(row),
          predictions.stddev.row(row),
          limit_stddev.size() == 0 ? unknown
                                   : ArrayXd(predictions.repeat(limit_stddev.row(row)).transpose().array()),
          takeMarginals(predictions.mixtures, row),
          {},
          takeFactors(predictions.interval_factors, row),
          predictions.weights,
          predictions.repeated};
}

SampleTerms calcSampleTerms(const ParameterSpec& parameter, const ParameterSamples& samples) {
  const ArrayXd scale = calcScale(parameter, samples.truth);
  const ArrayXd error = (samples.mean - samples.truth) / scale;
  const Scores scores = samples.mixtures.empty() ? scoreNormal(samples) : scoreMixtures(samples);
  const ArrayXd depth = toNormal(samples.factors, scores.depth);
  SampleTerms result{Eigen::MatrixXd(kTerms, error.size()), error.mean(), scores.z.mean()};
  auto terms = result.terms.array();
  terms.row(kError) = (error - result.error_offset).transpose();
  terms.row(kSquaredError) = terms.row(kError).square();
  terms.row(kAbsoluteError) = error.abs().transpose();
  terms.row(kWithin95) = calcWithin(depth, 0.95).transpose();
  terms.row(kWithin90) = calcWithin(depth, 0.90).transpose();
  terms.row(kWithin50) = calcWithin(depth, 0.50).transpose();
  terms.row(kClaimedVariance) = (samples.stddev / scale).square().transpose();
  terms.row(kZ) = (scores.z - result.z_offset).transpose();
  terms.row(kSquaredZ) = terms.row(kZ).square();
  terms.row(kSurprise) = scores.surprise.transpose();
  terms.row(kCrps) = (scores.crps / scale.abs()).transpose();
  terms.row(kSquaredLimit) = (samples.limit_stddev / scale).square().transpose();
  terms.row(kLimitSurprise) = (samples.limit_stddev.log() + (kLogRootTwoPi + 0.5)).transpose();
  result.terms = sumUp(result.terms, samples.weights, samples.repeated);
  return result;
}

VectorXd calcFigureValues(const SampleTerms& of, const VectorXd& mean, double samples) {
  return toVector(calcFigures(of, mean, samples));
}

}  // namespace twinmap
