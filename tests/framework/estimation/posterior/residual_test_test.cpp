#include "framework/estimation/posterior/noise/residual_test.hpp"

#include <gtest/gtest.h>

#include "framework/base/random/random.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr Index kSamples = 200;

/// Two outputs, sampled alternately.
std::vector<FeatureInfo> makeInfos() {
  std::vector<FeatureInfo> infos;
  for (Index i = 0; i < kSamples; ++i) {
    infos.push_back({"", "", static_cast<int>(i % 2), 0.1 * static_cast<double>(i / 2 + 1)});
  }
  return infos;
}

VectorXd drawNoise(std::uint64_t sample) {
  VectorXd noise(kSamples);
  RandomStream(3, RandomPurpose::kTestNoise).drawNormals(sample, 0, noise.data(), kSamples);
  return noise;
}

/// The share of 2000 residuals that are called a mismatch, each changed before it is tested.
template <class Change>
double calcShare(const Change& change) {
  constexpr int kCount = 2000;
  int found = 0;
  for (int i = 0; i < kCount; ++i) {
    VectorXd residual = drawNoise(static_cast<std::uint64_t>(i));
    change(residual);
    found += testResidual(residual, kSamples, makeInfos()).calcPValue() < kMismatchLevel;
  }
  return static_cast<double>(found) / kCount;
}

TEST(ResidualTest, CallsNoMoreGoodMeasurementsBadThanItSays) {
  const double share = calcShare([](VectorXd&) {});
  EXPECT_LT(share, 0.01 + 3.0 * std::sqrt(0.01 / 2000.0));
  EXPECT_GT(share, 0.002);  // three tests that hardly depend on each other share the 1 %
}

TEST(ResidualTest, FindsErrorsThatDependOnTheOnesBefore) {
  EXPECT_GT(calcShare([](VectorXd& r) {
              for (Index i = 2; i < r.size(); ++i) {
                r[i] = 0.5 * r[i - 2] + std::sqrt(0.75) * r[i];  // of the same size, autocorrelation .5
              }
            }),
            0.95);
}

TEST(ResidualTest, NamesTheOutputAndLagOfWhatDependsMost) {
  VectorXd residual = drawNoise(1);
  for (Index i = 2; i < kSamples; i += 2) {
    residual[i] = -0.8 * residual[i - 2] + 0.6 * residual[i];
  }
  ResidualTest test = testResidual(residual, kSamples, makeInfos());
  EXPECT_EQ(test.output, 0);
  EXPECT_EQ(test.lag, 1);
  EXPECT_NEAR(test.correlation, -0.8, 3.0 * 0.6 / 10.0);  // sd of an estimate from 100 samples: .6 / 10
  residual = drawNoise(2);
  for (Index i = 7; i < kSamples; i += 2) {
    residual[i] = 0.8 * residual[i - 6] + 0.6 * residual[i];
  }
  test = testResidual(residual, kSamples, makeInfos());
  EXPECT_EQ(test.output, 1);
  EXPECT_EQ(test.lag, 3);
  EXPECT_NEAR(test.correlation, 0.8, 3.0 * 0.6 / 10.0);
}

TEST(ResidualTest, MindsNoColourOfWhatIsFarBelowTheNoise) {
  const VectorXd drift = VectorXd::LinSpaced(kSamples, -1.0, 1.0);
  EXPECT_GT(testResidual(1e-3 * drift, kSamples, makeInfos()).calcPValue(), 0.99);
  EXPECT_LT(testResidual(0.1 * drift, kSamples, makeInfos()).calcPValue(), 1e-6);
}

TEST(ResidualTest, FindsASpikeAndNamesIt) {
  VectorXd residual = drawNoise(1);
  residual[77] = 7.0;
  const ResidualTest test = testResidual(residual, kSamples, makeInfos());
  EXPECT_LT(test.calcPValue(), 1e-6);
  EXPECT_EQ(test.largest, 77);
}

TEST(ResidualTest, FindsNoiseThatIsLargerThanStated) {
  EXPECT_GT(calcShare([](VectorXd& r) { r *= 1.3; }), 0.99);
}

TEST(ResidualTest, PValuesAreThoseOfTheTextbook) {
  VectorXd residual = VectorXd::Zero(4);
  residual[2] = -3.0;
  const ResidualTest test = testResidual(residual, 4.0, std::vector<FeatureInfo>(4));
  EXPECT_NEAR(test.chi_square_p, 0.06109948, 1e-7);  // scipy.stats.chi2.sf(9, 4)
  EXPECT_NEAR(test.largest_p, 0.010755516, 1e-7);    // 1 - (1 - 2 norm.sf(3))^4
  EXPECT_EQ(test.whiteness_p, 1.0);                  // no samples in time
}

}  // namespace
}  // namespace twinmap
