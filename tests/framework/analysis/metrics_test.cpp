#include "framework/analysis/metrics.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace twinmap {
namespace {

ParameterSpec makeParameter(double lower, double upper, RelativeTo relative_to = RelativeTo::kValue) {
  ParameterSpec parameter;
  parameter.bounds = {lower, upper, {}};
  parameter.relative_to = relative_to;
  return parameter;
}

// True 1, 2, 4; inferred 1.1, 1.8, 4; relative errors 10 %, -10 %, 0 %.
TEST(Metrics, ByHand) {
  Eigen::MatrixXd truth(1, 3);
  truth << 1, 2, 4;
  Estimates predictions{Eigen::MatrixXd(1, 3), Eigen::MatrixXd(1, 3)};
  predictions.mean << 1.1, 1.8, 4.0;
  predictions.stddev << 0.1, 0.05, 1.0;  // z = 1, -4, 0
  const ParameterMetrics metrics = calcMetrics({makeParameter(1, 4)}, truth, predictions).at(0);
  EXPECT_NEAR(metrics.bias_pct, 0.0, 1e-13);
  EXPECT_NEAR(metrics.sd_pct, 10.0, 1e-12);  // sqrt((100 + 100) / 2)
  EXPECT_NEAR(metrics.mare_pct, 20.0 / 3.0, 1e-12);
  EXPECT_NEAR(metrics.coverage95, 2.0 / 3.0, 1e-15);
  EXPECT_NEAR(metrics.coverage90, 2.0 / 3.0, 1e-15);
  EXPECT_NEAR(metrics.coverage50, 1.0 / 3.0, 1e-15);
  EXPECT_NEAR(metrics.stddev_pct, 100 * std::sqrt((0.01 + 0.000625 + 0.0625) / 3), 1e-12);
  EXPECT_NEAR(metrics.z_mean, -1.0, 1e-12);
  EXPECT_NEAR(metrics.z_sd, std::sqrt((4.0 + 9.0 + 1.0) / 2), 1e-12);
  const double log_stddevs = std::log(0.1) + std::log(0.05);
  EXPECT_NEAR(metrics.nlpd, (0.5 * 17.0 + log_stddevs) / 3 + 0.5 * std::log(2 * M_PI), 1e-12);
  EXPECT_EQ(metrics.samples, 3);
}

// z = 1, -4, 0 of intervals that reach 0.9 and 4.5.
TEST(Metrics, CoverageIsThatOfTheIntervalsThatAreClaimed) {
  const Eigen::RowVector3d truth(1, 2, 4);
  Estimates predictions{truth + Eigen::RowVector3d(0.1, -0.2, 0.0), Eigen::RowVector3d(0.1, 0.05, 1.0)};
  predictions.interval_factors = {Eigen::MatrixXd::Constant(1, 3, 0.9), Eigen::MatrixXd::Constant(1, 3, 4.5)};
  const ParameterMetrics metrics = calcMetrics({makeParameter(1, 4)}, truth, predictions).at(0);
  EXPECT_EQ(metrics.coverage95, 1.0);
  EXPECT_NEAR(metrics.coverage90, 2.0 / 3.0, 1e-15);
  EXPECT_NEAR(metrics.coverage50, 1.0 / 3.0, 1e-15);
  EXPECT_NEAR(metrics.z_sd, std::sqrt((4.0 + 9.0 + 1.0) / 2), 1e-12);
}

/// Six samples with two kinds of estimates: three need the exact one, which of `sampled` is known. Refined
/// estimates stand for themselves where `near`, else the sampled ones stand for all three.
Estimates makeTwoKinds(const std::vector<Eigen::Index>& sampled, bool near) {
  const Eigen::RowVectorXd refined = (Eigen::RowVectorXd(6) << 1.1, 1.8, 4.0, 1.5, 2.3, 3.0).finished();
  const Eigen::RowVectorXd exact = (Eigen::RowVectorXd(6) << 0, 0, 0, 1.3, 2.5, 3.1).finished();
  Estimates estimates{refined, Eigen::RowVectorXd::Constant(6, 0.3)};
  const double weight = 3.0 / static_cast<double>(sampled.size());
  estimates.weights = Eigen::VectorXd::Ones(6);
  estimates.weights.tail(3).setConstant(near ? 1.0 : 0.0);
  for (const Eigen::Index i : sampled) {
    estimates.mean(0, i) = exact[i];
    estimates.weights[i] = weight;
  }
  if (near) {
    estimates.repeated = sampled;
    estimates.mean.conservativeResize(1, 6 + static_cast<Eigen::Index>(sampled.size()));
    estimates.mean.rightCols(static_cast<Eigen::Index>(sampled.size())) = refined(sampled);
    estimates.stddev.setConstant(1, estimates.mean.cols(), 0.3);
    estimates.weights.conservativeResize(estimates.mean.cols());
    estimates.weights.tail(static_cast<Eigen::Index>(sampled.size())).setConstant(1.0 - weight);
  }
  return estimates;
}

const Eigen::RowVectorXd kSixTruths = (Eigen::RowVectorXd(6) << 1, 2, 4, 1.4, 2.1, 3.3).finished();

// The mean over all choices of two of the three is the figure with all three, whatever the kinds have to do
// with one another.
TEST(Metrics, OfFewSampledOnesAreRightOnAverage) {
  const std::vector<ParameterSpec> parameters{makeParameter(1, 4)};
  const ParameterMetrics all = calcMetrics(parameters, kSixTruths, makeTwoKinds({3, 4, 5}, false)).at(0);
  for (const bool near : {false, true}) {
    double bias = 0.0, mare = 0.0, coverage = 0.0, nlpd = 0.0;
    for (const std::vector<Eigen::Index>& pair :
         {std::vector<Eigen::Index>{3, 4}, std::vector<Eigen::Index>{3, 5},
          std::vector<Eigen::Index>{4, 5}}) {
      const ParameterMetrics some = calcMetrics(parameters, kSixTruths, makeTwoKinds(pair, near)).at(0);
      bias += some.bias_pct / 3;
      mare += some.mare_pct / 3;
      coverage += some.coverage95 / 3;
      nlpd += some.nlpd / 3;
      EXPECT_EQ(some.samples, near ? 6 : 5);
      EXPECT_GT(some.se.bias_pct, 0.0);
    }
    EXPECT_NEAR(bias, all.bias_pct, 1e-12);
    EXPECT_NEAR(mare, all.mare_pct, 1e-12);
    EXPECT_NEAR(coverage, all.coverage95, 1e-12);
    EXPECT_NEAR(nlpd, all.nlpd, 1e-12);
  }
}

// One for each is as if nothing were said of weights.
TEST(Metrics, WeightsOfOneChangeNothing) {
  Estimates weighted = makeTwoKinds({3, 4, 5}, false), plain = weighted;
  plain.weights.resize(0);
  const ParameterMetrics a = calcMetrics({makeParameter(1, 4)}, kSixTruths, weighted).at(0);
  const ParameterMetrics b = calcMetrics({makeParameter(1, 4)}, kSixTruths, plain).at(0);
  for (const FigureColumn& column : kFigureColumns) {
    if (!column.needs_limit) {
      EXPECT_NEAR(a.*column.value, b.*column.value, 1e-12) << column.name;
      EXPECT_NEAR(a.se.*column.value, b.se.*column.value, 1e-12) << column.name;
    }
  }
}

// Of a stratum of which two of three are known the mean has the variance of a weighted one.
TEST(Metrics, StandardErrorsAreThoseOfTheSampledOnes) {
  const Estimates some = makeTwoKinds({3, 5}, false);
  const ParameterMetrics metrics = calcMetrics({makeParameter(1, 4)}, kSixTruths, some).at(0);
  const Eigen::ArrayXd error = (some.mean - kSixTruths).cwiseQuotient(kSixTruths).transpose();
  const double mean = (some.weights.array() * error).sum() / 6;
  const double squares = (some.weights.array() * (error - mean)).square().sum();
  EXPECT_NEAR(metrics.se.bias_pct, 100 * std::sqrt(squares / (6 * 5)), 1e-12);
}

TEST(Metrics, RelativeToTheRangeWhereTheParameterSaysSo) {
  Eigen::MatrixXd truth(1, 2);
  truth << 0, 1;
  const Estimates predictions{truth.array() + 0.2, Eigen::MatrixXd::Ones(1, 2)};
  const ParameterMetrics metrics =
      calcMetrics({makeParameter(-1, 3, RelativeTo::kRange)}, truth, predictions).at(0);
  EXPECT_NEAR(metrics.bias_pct, 5.0, 1e-12);
  EXPECT_NEAR(metrics.sd_pct, 0.0, 1e-12);
  EXPECT_NEAR(metrics.mare_pct, 5.0, 1e-12);
}

// Scales 2 and 4, limits 0.1 and 0.4: relative 5 % and 10 %. Errors 10 % and -10 %: sd 10 sqrt(2) %.
TEST(Metrics, TheInformationLimitIsRelativeAsTheStandardDeviationIs) {
  const Eigen::RowVector2d truth(2, 4), limit(0.1, 0.4);
  const Estimates predictions{Eigen::RowVector2d(2.2, 3.6), Eigen::RowVector2d(1, 1)};
  const auto calc = [&](const Eigen::MatrixXd& limit_stddev, RelativeTo relative_to = RelativeTo::kValue) {
    return calcMetrics({makeParameter(1, 5, relative_to)}, truth, predictions, limit_stddev).at(0);
  };
  EXPECT_NEAR(calc(limit).limit_pct, std::sqrt((25.0 + 100.0) / 2), 1e-12);
  EXPECT_NEAR(calc(limit).ratio_to_limit, 10 * std::sqrt(2.0) / std::sqrt(62.5), 1e-12);
  EXPECT_NEAR(calc(limit, RelativeTo::kRange).limit_pct, 100 * std::sqrt((0.01 + 0.16) / 2) / 4, 1e-12);
  for (const Eigen::MatrixXd& unknown :
       {Eigen::MatrixXd(), Eigen::MatrixXd(Eigen::RowVector2d(0.1, std::nan("")))}) {
    EXPECT_TRUE(std::isnan(calc(unknown).limit_pct));
    EXPECT_TRUE(std::isnan(calc(unknown).ratio_to_limit));
    EXPECT_TRUE(std::isnan(calc(unknown).nats_above_limit));
    EXPECT_NEAR(calc(unknown).sd_pct, 10 * std::sqrt(2.0), 1e-12);
  }
}

// Errors of one standard deviation each, as is said of them: only what exceeds the limit is lost.
TEST(Metrics, TheDensityIsComparedWithThatOfTheLimit) {
  const Eigen::RowVector2d truth(2, 4), stddev(0.2, 1.2), limit(0.1, 0.4);
  const auto calc = [&](const Eigen::RowVector2d& mean) {
    return calcMetrics({makeParameter(1, 5)}, truth, {mean, stddev}, limit).at(0).nats_above_limit;
  };
  EXPECT_NEAR(calc({2.2, 2.8}), (std::log(2.0) + std::log(3.0)) / 2, 1e-12);
  EXPECT_NEAR(calc({2.2, 1.6}), (std::log(2.0) + std::log(3.0)) / 2 + 0.75,
              1e-12);  // (4 - 1) / 2 of one of two
}

// A bias a million times the spread costs the spread no digits.
TEST(Metrics, ASmallSpreadAboutALargeBiasKeepsItsDigits) {
  const Eigen::RowVector3d truth(1, 1, 1);
  const Estimates predictions{Eigen::RowVector3d(3, 3 + 1e-6, 3 + 2e-6), Eigen::RowVector3d(1, 1, 1)};
  const ParameterMetrics metrics = calcMetrics({makeParameter(1, 5)}, truth, predictions).at(0);
  EXPECT_NEAR(metrics.sd_pct, 1e-4, 1e-13);
  EXPECT_NEAR(metrics.z_sd, 1e-6, 1e-15);
}

// Errors drawn at the quantiles of the claimed distribution are covered as claimed.
TEST(Metrics, ACalibratedStandardDeviationIsCoveredAsClaimed) {
  constexpr int kSamples = 1000;
  Eigen::MatrixXd truth = Eigen::MatrixXd::Constant(1, kSamples, 2.0);
  Estimates predictions{truth, Eigen::MatrixXd::Constant(1, kSamples, 0.3)};
  for (int i = 0; i < kSamples; ++i) {
    const double probability = (i + 0.5) / kSamples;
    double low = -10, high = 10;  // bisection: the normal quantile, independent of the code under test
    for (int k = 0; k < 100; ++k) {
      const double middle = 0.5 * (low + high);
      (0.5 * std::erfc(-middle / std::sqrt(2.0)) < probability ? low : high) = middle;
    }
    predictions.mean(0, i) += 0.3 * low;
  }
  const ParameterMetrics metrics = calcMetrics({makeParameter(1, 4)}, truth, predictions).at(0);
  EXPECT_NEAR(metrics.coverage95, 0.95, 1.5 / kSamples);
  EXPECT_NEAR(metrics.coverage90, 0.90, 1.5 / kSamples);
  EXPECT_NEAR(metrics.coverage50, 0.50, 1.5 / kSamples);
  EXPECT_NEAR(metrics.z_sd, 1.0, 0.01);
}

}  // namespace
}  // namespace twinmap
