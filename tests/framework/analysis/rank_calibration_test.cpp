#include "framework/analysis/rank_calibration.hpp"

#include <gtest/gtest.h>

#include "framework/base/random/random.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Normal parameters of prior variance 1, measured with noise of variance 1: their posterior is normal, of
// half the measurement as mean and variance 1/2. `width` and `offset` (in standard deviations) make it wrong.
// Of the draws so many are distinct.
RankCalibration calibrateNormalPosteriors(Index measurements, double width, double offset,
                                          Index parameters = 3, Index distinct = 400) {
  const RandomStream random(7, RandomPurpose::kVerification);
  Eigen::MatrixXi ranks(parameters + 1, measurements);
  for (Index i = 0; i < measurements; ++i) {
    const auto normal = [&](Index channel, Index replicate) {
      return random.calcNormal(static_cast<std::uint64_t>(i), static_cast<std::uint64_t>(channel),
                               static_cast<std::uint64_t>(replicate));
    };
    const VectorXd truth = VectorXd::NullaryExpr(parameters, [&](Index j) { return normal(j, 0); });
    const VectorXd mean =
        VectorXd::NullaryExpr(parameters, [&](Index j) { return 0.5 * (truth[j] + normal(j, 1)); });
    const MatrixXd draws = MatrixXd::NullaryExpr(parameters, 400, [&](Index j, Index k) {
      return mean[j] + std::sqrt(0.5) * (offset + width * normal(j, 2 + k % distinct));
    });
    const MatrixXd covariance = 0.5 * MatrixXd::Identity(parameters, parameters);
    ranks.col(i) = calcRanks(truth, draws, {mean, covariance});
  }
  return calcRankCalibration(ranks);
}

TEST(Ranks, CountDrawsBelowTheTruthAndNearerByTheMetric) {
  MatrixXd draws(2, kRankDraws + 20);
  for (Index k = 0; k < draws.cols(); ++k) {
    draws.col(k) << static_cast<double>(k), static_cast<double>((7 * k) % draws.cols());
  }
  const VectorXd origin = VectorXd::Zero(2);
  MatrixXd covariance = MatrixXd::Identity(2, 2);
  EXPECT_EQ(calcRanks(Eigen::Vector2d(10.5, -1), draws, {origin, covariance}).head(2),
            Eigen::Vector2i(11, 0));
  EXPECT_EQ(calcRanks(Eigen::Vector2d(1e6, 1e6), draws, {origin, covariance}),
            Eigen::Vector3i::Constant(kRankDraws));
  covariance(1, 1) = 1e12;  // the second row tells nothing
  EXPECT_EQ(calcRanks(Eigen::Vector2d(10.5, -1), draws, {origin, covariance})[2], 11);
}

TEST(RankCalibration, HasEqualCountsAndNoSmallProbabilityWhereRanksAreSpreadEvenly) {
  const Eigen::MatrixXi ranks = Eigen::RowVectorXi::LinSpaced(200, 0, static_cast<int>(kRankDraws));
  const RankCalibration found = calcRankCalibration(ranks);
  EXPECT_EQ(found.counts, Eigen::VectorXi::Constant(20, 10));
  EXPECT_EQ(found.chi_square[0], 0.0);
  EXPECT_EQ(found.p_value[0], 1.0);
}

// scipy.stats.chi2.sf(x, 9), x = sum (count - 19.9)^2 / 19.9
TEST(RankCalibration, TellsChiSquareAndItsProbability) {
  Eigen::RowVectorXi ranks(199);
  const int counts[] = {30, 20, 19, 19, 19, 19, 19, 18, 18, 18};
  Index next = 0;
  for (int bin = 0; bin < 10; ++bin) {
    for (int k = 0; k < counts[bin]; ++k) {
      ranks[next++] = 20 * bin + k % 20;
    }
  }
  const RankCalibration found = calcRankCalibration(ranks);
  EXPECT_NEAR(found.chi_square[0], 5.8743718592964855, 1e-12);
  EXPECT_NEAR(found.p_value[0], 0.7524229081190775, 1e-12);
}

TEST(RankCalibration, FindsNothingWrongWithRightPosteriors) {
  const RankCalibration found = calibrateNormalPosteriors(500, 1.0, 0.0);
  EXPECT_EQ(found.counts.rows(), 20);
  EXPECT_TRUE(findMiscalibrated(found).empty()) << found.p_value.transpose();
}

TEST(RankCalibration, FindsNothingWrongWithFewDistinctDrawsOfManyParameters) {
  const RankCalibration found = calibrateNormalPosteriors(2000, 1.0, 0.0, 8, 100);
  EXPECT_TRUE(findMiscalibrated(found).empty()) << found.p_value.transpose();
}

TEST(RankCalibration, NamesWhatIsTooNarrowTooWideOrOffset) {
  const std::vector<Index> all{0, 1, 2, 3};
  EXPECT_EQ(findMiscalibrated(calibrateNormalPosteriors(500, 0.7, 0.0)), all);
  EXPECT_EQ(findMiscalibrated(calibrateNormalPosteriors(500, 1.4, 0.0)), all);
  EXPECT_EQ(findMiscalibrated(calibrateNormalPosteriors(500, 1.0, 0.5)), all);
}

}  // namespace
}  // namespace twinmap
