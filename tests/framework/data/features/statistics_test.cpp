#include "framework/data/features/statistics.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "framework/data/features/feature_extractor.hpp"

namespace twinmap {
namespace {

FeatureSpec makeStatistics(std::vector<Name> outputs, const WindowSpec& window,
                           std::vector<Statistic> quantities) {
  return StatisticsFeatureSpec{std::move(outputs), window, std::move(quantities)};
}

TEST(Statistics, AreThoseOfAHandComputedWindow) {
  const std::vector<FeatureSpec> features{
      makeStatistics({{"b", {}}}, {1.0, 1.0, 4},
                     {Statistic::kMax, Statistic::kStddev, Statistic::kMean, Statistic::kRms, Statistic::kMin,
                      Statistic::kPeakToPeak})};
  const ResponseLayout layout{{"a", "b"}, {"m", "rad"}, Eigen::VectorXd::LinSpaced(6, 0.0, 5.0)};
  Eigen::VectorXd response(12);
  response << 9, 9, 9, 9, 9, 9, 50, 1, -2, 3, 6, 70;  // the window of b holds 1, -2, 3, 6
  const FeatureExtractor extractor(features, layout);
  const Eigen::VectorXd found = extractor.extract(response);
  const Eigen::VectorXd expected =
      (Eigen::VectorXd(6) << 2.0, 6.0, std::sqrt(34.0 / 3.0), std::sqrt(12.5), -2.0, 8.0).finished();
  EXPECT_LT((found - expected).norm(), 1e-14);
  EXPECT_EQ(extractor.getInfos()[0].name, "mean b(1 s to 4 s)");
  EXPECT_EQ(extractor.getInfos()[1].name, "max b(1 s to 4 s)");
  EXPECT_EQ(extractor.getInfos()[5].unit, "rad");
  EXPECT_EQ(extractor.getInfos()[5].output, 1);
}

TEST(Statistics, OnlyTheMeanIsLinear) {
  const ResponseLayout layout{{"a"}, {"m"}, Eigen::VectorXd::LinSpaced(3, 0.0, 2.0)};
  const WindowSpec window{0.0, 1.0, 3};
  EXPECT_TRUE(FeatureExtractor({makeStatistics({{"a", {}}}, window, {Statistic::kMean})}, layout).isLinear());
  EXPECT_FALSE(FeatureExtractor({makeStatistics({{"a", {}}}, window, {Statistic::kMax})}, layout).isLinear());
}

TEST(Statistics, OfAFailedSampleAreMissing) {
  const ResponseLayout layout{{"a"}, {"m"}, Eigen::VectorXd::LinSpaced(3, 0.0, 2.0)};
  const FeatureExtractor extractor({makeStatistics({{"a", {}}}, {0.0, 1.0, 3},
                                                   {Statistic::kMean, Statistic::kMin, Statistic::kMax,
                                                    Statistic::kRms, Statistic::kPeakToPeak})},
                                   layout);
  Eigen::MatrixXd responses = Eigen::MatrixXd::Constant(3, 2, std::nan(""));
  responses.col(1) << 1, 2, 3;
  const Eigen::MatrixXd found = extractor.extract(responses);
  EXPECT_TRUE(found.col(0).array().isNaN().all());
  EXPECT_TRUE(found.col(1).allFinite());
}

}  // namespace
}  // namespace twinmap
