#include "framework/analysis/jackknife.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "framework/analysis/metrics.hpp"
#include "framework/base/random/random.hpp"

namespace twinmap {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

JackknifeFigures calcMean(const MatrixXd& terms, int draws = 1) {
  return calcWithJackknife(
      terms, [](const VectorXd& mean, double) { return mean; }, draws);
}

TEST(Jackknife, OfAMeanIsItsStandardErrorExactly) {
  const Eigen::RowVector4d values(1, 2, 4, 9);  // mean 4, squared deviations 9 + 4 + 0 + 25 = 38
  const JackknifeFigures estimates = calcMean(values);
  EXPECT_DOUBLE_EQ(estimates.value[0], 4.0);
  EXPECT_NEAR(estimates.standard_error[0], std::sqrt(38.0 / 3.0) / std::sqrt(4.0), 1e-14);
}

// By hand: of the variance with 1/(n-1) of 0, 1, 3 without one each: 2, 4.5, 0.5.
TEST(Jackknife, LeavesEverySampleOutOfTheWholeFigure) {
  MatrixXd terms(2, 3);
  terms << 0, 1, 3, 0, 1, 9;
  const JackknifeFigures estimates = calcWithJackknife(terms, [](const VectorXd& mean, double samples) {
    return VectorXd::Constant(1, (mean[1] - mean[0] * mean[0]) * samples / (samples - 1));
  });
  EXPECT_NEAR(estimates.value[0], 7.0 / 3.0, 1e-14);
  const double middle = 7.0 / 3.0;
  EXPECT_NEAR(estimates.standard_error[0],
              std::sqrt(2.0 / 3.0 *
                        (std::pow(2 - middle, 2) + std::pow(4.5 - middle, 2) + std::pow(0.5 - middle, 2))),
              1e-13);
}

// Copies of a sample are no news: the error is that of the samples, not smaller by sqrt(draws).
TEST(Jackknife, DrawsOfOneSampleLeaveTogether) {
  const Eigen::RowVector4d values(1, 2, 4, 9);
  EXPECT_NEAR(calcMean(values.replicate(1, 5), 5).standard_error[0], calcMean(values).standard_error[0],
              1e-13);
  EXPECT_LT(calcMean(values.replicate(1, 5), 1).standard_error[0], 0.5 * calcMean(values).standard_error[0]);
}

struct TestSet {
  MatrixXd truth, limit_stddev;
  Estimates predictions;
};

TestSet makeTestSet(int samples) {
  const RandomStream random(3, RandomPurpose::kTestNoise);
  TestSet set{MatrixXd(1, samples), MatrixXd(1, samples), {MatrixXd(1, samples), MatrixXd(1, samples)}};
  for (int i = 0; i < samples; ++i) {
    set.truth(i) = 2.0 + random.calcUniform(i, 0);
    set.predictions.stddev(i) = 0.1 + 0.1 * random.calcUniform(i, 1);
    set.predictions.mean(i) = set.truth(i) + 0.03 + 1.2 * set.predictions.stddev(i) * random.calcNormal(i, 2);
    set.limit_stddev(i) = 0.8 * set.predictions.stddev(i);
  }
  return set;
}

ParameterMetrics calcOn(const TestSet& set, const std::vector<int>& samples) {
  ParameterSpec parameter;
  parameter.bounds = {2, 3, {}};
  return calcMetrics({parameter}, set.truth(Eigen::all, samples),
                     {set.predictions.mean(Eigen::all, samples), set.predictions.stddev(Eigen::all, samples)},
                     set.limit_stddev(Eigen::all, samples))
      .at(0);
}

// Against 2000 resamples of the test set, recomputed whole. A standard deviation of B resamples has a
// relative error of 1/sqrt(2 B), 1.6 %; jackknife and bootstrap differ by O(1/n).
TEST(Jackknife, AgreesWithTheBootstrapForEveryMetric) {
  constexpr int kSamples = 300, kResamples = 2000;
  const TestSet set = makeTestSet(kSamples);
  std::vector<int> chosen(kSamples);
  for (int i = 0; i < kSamples; ++i) {
    chosen[i] = i;
  }
  const ParameterMetrics metrics = calcOn(set, chosen);
  std::mt19937_64 engine(1);
  MatrixXd figures(kFigureColumns.size(), kResamples);
  for (int r = 0; r < kResamples; ++r) {
    for (int& sample : chosen) {
      sample = static_cast<int>(engine() % kSamples);
    }
    const ParameterMetrics resampled = calcOn(set, chosen);
    for (std::size_t k = 0; k < kFigureColumns.size(); ++k) {
      figures(static_cast<Eigen::Index>(k), r) = resampled.*kFigureColumns[k].value;
    }
  }
  figures.colwise() -= figures.rowwise().mean().eval();
  const VectorXd bootstrap = (figures.rowwise().squaredNorm() / (kResamples - 1)).cwiseSqrt();
  for (std::size_t k = 0; k < kFigureColumns.size(); ++k) {
    const double expected = bootstrap[static_cast<Eigen::Index>(k)];
    EXPECT_GT(expected, 0.0) << kFigureColumns[k].name;
    EXPECT_NEAR(metrics.se.*kFigureColumns[k].value / expected, 1.0, 0.08) << kFigureColumns[k].name;
  }
}

}  // namespace
}  // namespace twinmap
