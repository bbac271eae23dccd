#include "framework/data/sensitivity/fisher_information.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "tests/lu.hpp"

namespace twinmap {
namespace {

using Eigen::MatrixXd;

MatrixXd makeCovariance() {
  MatrixXd covariance(3, 3);
  covariance << 4.0, 1.0, 0.0, 1.0, 2.0, 0.5, 0.0, 0.5, 1.0;
  return covariance;
}

TEST(FisherInformation, ByHandForIndependentNoise) {
  const NoiseWhitener noise(MatrixXd(Eigen::Vector2d(4.0, 0.25).asDiagonal()));
  MatrixXd sensitivities(2, 2);
  sensitivities << 2.0, 0.0, 1.0, 3.0;
  MatrixXd expected(2, 2);  // 1/4 [2 0]'[2 0] + 4 [1 3]'[1 3]
  expected << 5.0, 12.0, 12.0, 36.0;
  EXPECT_LT((calcFisherInformation(noise, sensitivities) - expected).norm(), 1e-13);
}

TEST(FisherInformation, IsThatOfTheInverseCovariance) {
  const MatrixXd sensitivities = MatrixXd::Random(3, 2);
  const MatrixXd expected = sensitivities.transpose() * test::calcInverse(makeCovariance()) * sensitivities;
  EXPECT_LT((calcFisherInformation(NoiseWhitener(makeCovariance()), sensitivities) - expected).norm(), 1e-13);
}

TEST(FisherInformation, AFeatureGivenTwiceSaysNothingNew) {
  MatrixXd repeat = MatrixXd::Zero(4, 3);
  repeat.topRows(3).setIdentity();
  repeat(3, 1) = 5.0;  // the second feature again, in another unit
  const MatrixXd sensitivities = MatrixXd::Random(3, 2);
  const MatrixXd once = calcFisherInformation(NoiseWhitener(makeCovariance()), sensitivities);
  const NoiseWhitener noise(repeat * makeCovariance() * repeat.transpose());
  EXPECT_EQ(noise.countDirections(), 3);
  EXPECT_LT((calcFisherInformation(noise, repeat * sensitivities) - once).norm(), 1e-9 * once.norm());
}

TEST(FisherInformation, WithoutDataTheLimitIsTheBoxsOwnSpread) {
  const MatrixXd limit = calcLimitCovariance(MatrixXd::Zero(2, 2));
  EXPECT_NEAR(std::sqrt(limit(0, 0)), 1.0 / std::sqrt(12.0), 1e-15);
  EXPECT_EQ(limit(0, 1), 0.0);
}

TEST(FisherInformation, WithMuchDataTheLimitIsCramersAndRaos) {
  MatrixXd information(2, 2);
  information << 5e8, 1e8, 1e8, 3e8;
  EXPECT_LT((calcLimitCovariance(information) - test::calcInverse(information)).norm(),
            1e-7 * test::calcInverse(information).norm());
}

TEST(NoiseWhitener, MakesUnitNoise) {
  const MatrixXd whitening = NoiseWhitener(makeCovariance()).makeMatrix();
  EXPECT_LT((whitening * makeCovariance() * whitening.transpose() - MatrixXd::Identity(3, 3)).norm(), 1e-14);
  EXPECT_THROW(NoiseWhitener(NoiseCovariance(MatrixXd::Zero(2, 2))), std::invalid_argument);
}

TEST(FisherInformation, WithCorrelatedPriorsLeavesTheBlockOfTheWholeCovariance) {
  MatrixXd information(3, 3), prior(3, 3);
  information << 9, 2, 4, 2, 5, -1, 4, -1, 7;
  prior << 20, 6, 3, 6, 15, 5, 3, 5, 30;
  const MatrixXd expected = test::calcInverse(information + prior).topLeftCorner(2, 2);
  const MatrixXd of_two = calcMarginalPrior(prior, 2);
  EXPECT_LT((of_two - test::calcInverse(test::calcInverse(prior).topLeftCorner(2, 2))).norm(), 1e-12);
  EXPECT_LT((calcLimitCovariance(calcMarginalInformation(information, 2, prior), of_two) - expected).norm(),
            1e-14);
}

TEST(FisherInformation, OfUniformPriorsIsThatOfTheBox) {
  MatrixXd information(3, 3);
  information << 9, 2, 4, 2, 5, -1, 4, -1, 7;
  EXPECT_EQ(calcMarginalInformation(information, 1, makeUniformInformation(3)),
            calcMarginalInformation(information, 1));
  EXPECT_EQ(calcLimitCovariance(information, makeUniformInformation(3)), calcLimitCovariance(information));
}

}  // namespace
}  // namespace twinmap
