#include "framework/analysis/paired_bootstrap.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "framework/base/random/random.hpp"
#include "tests/framework/analysis/golden/bootstrap_golden.hpp"

namespace twinmap {
namespace {

using Eigen::ArrayXd;
using Eigen::VectorXd;

TermSet makeMeanSet(const ArrayXd& values) {
  return {values.matrix().transpose(), [](const VectorXd& mean, double) { return mean; }};
}

/// The figure is the standard deviation with 1/(n-1).
TermSet makeStddevSet(const ArrayXd& values) {
  Eigen::MatrixXd terms(2, values.size());
  terms.row(0) = values.transpose();
  terms.row(1) = values.square().transpose();
  return {terms, [](const VectorXd& mean, double n) {
            return VectorXd::Constant(1, std::sqrt(std::max(0.0, mean[1] - mean[0] * mean[0]) * n / (n - 1)));
          }};
}

template <std::size_t N>
ArrayXd toArray(const std::array<double, N>& values) {
  return Eigen::Map<const Eigen::Array<double, N, 1>>(values.data());
}

// Two pairs with differences 0 and 2: a resample's mean difference is 0, 1, 2 with probability 1/4, 1/2, 1/4,
// symmetric, so that nothing is corrected: quantiles 0.3 and 0.7 are both 1, 0.025 and 0.975 are 0 and 2.
TEST(PairedBootstrap, ByHand) {
  const TermSet a = makeMeanSet(Eigen::Array2d(5, 7)), b = makeMeanSet(Eigen::Array2d(5, 9));
  const DifferenceIntervals wide = calcPairedIntervals(a, b);
  EXPECT_EQ(wide.difference[0], 1.0);
  EXPECT_EQ(wide.lower[0], 0.0);
  EXPECT_EQ(wide.upper[0], 2.0);
  const DifferenceIntervals narrow = calcPairedIntervals(a, b, {10000, 0.4, 1});
  EXPECT_EQ(narrow.lower[0], 1.0);
  EXPECT_EQ(narrow.upper[0], 1.0);
}

// The quantiles of 40000 resamples move by 0.01 between seeds; percentile intervals are off by 0.12 and more.
TEST(PairedBootstrap, AgreesWithScipysBca) {
  const TermSet a = makeStddevSet(toArray(bootstrap_golden::kA));
  const TermSet b = makeStddevSet(toArray(bootstrap_golden::kB));
  constexpr double kTolerance = 0.03;
  const DifferenceIntervals paired = calcPairedIntervals(a, b, {40000, 0.95, 1});
  EXPECT_NEAR(paired.lower[0], bootstrap_golden::kPaired[0], kTolerance);
  EXPECT_NEAR(paired.upper[0], bootstrap_golden::kPaired[1], kTolerance);
  const DifferenceIntervals unpaired = calcUnpairedIntervals(a, b, {40000, 0.95, 1});
  EXPECT_NEAR(unpaired.lower[0], bootstrap_golden::kUnpaired[0], kTolerance);
  EXPECT_NEAR(unpaired.upper[0], bootstrap_golden::kUnpaired[1], kTolerance);
}

// Errors of sd 1 and 0.7 with correlation 0.8. Of 400 sets, 95 % +- 3.3 % (three standard deviations) should
// be covered; 60 samples cost BCa some 2 % of coverage.
TEST(PairedBootstrap, CoversTheTrueDifferenceAsOftenAsItSays) {
  constexpr int kSets = 400, kSamples = 60;
  const RandomStream random(7, RandomPurpose::kTestNoise);
  int paired = 0, unpaired = 0;
  for (int set = 0; set < kSets; ++set) {
    const auto draw = [&](int channel) {
      return ArrayXd(
          ArrayXd::NullaryExpr(kSamples, [&](Eigen::Index i) { return random.calcNormal(i, channel, set); }));
    };
    const ArrayXd common = draw(0);
    const TermSet a = makeStddevSet(common), b = makeStddevSet(0.7 * (0.8 * common + 0.6 * draw(1)));
    const TermSet independent = makeStddevSet(0.7 * draw(2));
    const auto covers = [](const DifferenceIntervals& of) {
      return of.lower[0] < -0.3 && -0.3 < of.upper[0];
    };
    paired += covers(calcPairedIntervals(a, b, {500, 0.95, 1})) ? 1 : 0;
    unpaired += covers(calcUnpairedIntervals(a, independent, {500, 0.95, 1})) ? 1 : 0;
  }
  for (const int covered : {paired, unpaired}) {
    EXPECT_GT(covered, 0.90 * kSets);
    EXPECT_LT(covered, 0.985 * kSets);
  }
}

TEST(PairedBootstrap, WhatBothHaveInCommonCancelsInPairsOnly) {
  const ArrayXd common = toArray(bootstrap_golden::kA);
  const TermSet a = makeMeanSet(10 * common), b = makeMeanSet(10 * common + toArray(bootstrap_golden::kB));
  const auto width = [](const DifferenceIntervals& of) { return of.upper[0] - of.lower[0]; };
  EXPECT_GT(width(calcUnpairedIntervals(a, b)), 10 * width(calcPairedIntervals(a, b)));
}

TEST(PairedBootstrap, EqualSetsDifferByNothingAndExchangedSetsByTheOpposite) {
  const TermSet a = makeStddevSet(toArray(bootstrap_golden::kA));
  const TermSet b = makeStddevSet(toArray(bootstrap_golden::kB));
  const DifferenceIntervals none = calcPairedIntervals(a, a);
  EXPECT_EQ(none.lower[0], 0.0);
  EXPECT_EQ(none.upper[0], 0.0);
  const DifferenceIntervals forth = calcPairedIntervals(a, b), back = calcPairedIntervals(b, a);
  EXPECT_NEAR(forth.lower[0], -back.upper[0], 1e-12);
  EXPECT_NEAR(forth.upper[0], -back.lower[0], 1e-12);
}

TEST(PairedBootstrap, DependsOnItsSeedAlone) {
  const TermSet a = makeStddevSet(toArray(bootstrap_golden::kA));
  const TermSet b = makeStddevSet(toArray(bootstrap_golden::kB));
  const DifferenceIntervals first = calcPairedIntervals(a, b), again = calcPairedIntervals(a, b);
  EXPECT_EQ(first.lower, again.lower);
  EXPECT_EQ(first.upper, again.upper);
  EXPECT_NE(first.lower, calcPairedIntervals(a, b, {10000, 0.95, 2}).lower);
}

TEST(PairedBootstrap, AFigureThatIsNoNumberHasNoInterval) {
  ArrayXd values = toArray(bootstrap_golden::kA);
  const TermSet known = makeMeanSet(values);
  values[3] = std::nan("");
  const DifferenceIntervals intervals = calcPairedIntervals(known, makeMeanSet(values));
  EXPECT_TRUE(std::isnan(intervals.lower[0]) && std::isnan(intervals.upper[0]));
}

// Figures come from means: one evaluation per resample, one per sample left out, and few more.
TEST(PairedBootstrap, EvaluatesFiguresOncePerResampleAndSample) {
  constexpr int kResamples = 300, kSamples = 200;
  int calls = 0;
  TermSet set = makeMeanSet(ArrayXd::LinSpaced(kSamples, 0, 1));
  set.figures = [&calls](const VectorXd& mean, double) {
    ++calls;
    return mean;
  };
  calcPairedIntervals(set, makeMeanSet(ArrayXd::LinSpaced(kSamples, 0, 2)), {kResamples, 0.95, 1});
  EXPECT_GE(calls, kResamples + kSamples);
  EXPECT_LT(calls, kResamples + kSamples + 20);
}

}  // namespace
}  // namespace twinmap
