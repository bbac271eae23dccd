#include <gtest/gtest.h>

#include "framework/data/noise/feature_noise.hpp"
#include "framework/estimation/network/train_network_map.hpp"
#include "tests/framework/estimation/network/small_networks.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd samplePairs(Index count) {
  const RandomStream random(1, RandomPurpose::kTrainDesign);
  return MatrixXd::NullaryExpr(2, count, [&](Index i, Index j) {
    return (i == 0 ? -1.0 : 0.0) + (i == 0 ? 2.0 : 1.0) * random.calcUniform(j, i);
  });
}

/// Of two parameters two responses (2 x count).
NetworkMapTraining trainOnPairs(const MatrixXd& points, const MatrixXd& responses, NetworkHead head,
                                int components = 3) {
  ModelSpec model;
  model.parameters = {makeParameter("side", -1.0, 1.0), makeParameter("size", 0.0, 1.0)};
  const std::vector<FeatureSpec> features{SamplesFeatureSpec{{{"y", {}}}, 1.0, 1.0, 2}};
  const ResponseLayout layout{{"y"}, {"m"}, collectTimes(features)};
  const FeatureExtractor extractor(features, layout);
  const ResponseNoise noise(VectorXd::Constant(2, kNoise));
  const FeatureTransform transform{{AffineStep{VectorXd::Zero(2), VectorXd::Constant(2, kNoise), {}}}};
  const MatrixXd covariance = kNoise * kNoise * MatrixXd::Identity(2, 2);
  NetworkMapSpec spec = makeSpec(1200);
  spec.head = head;
  spec.components = components;
  return trainNetworkMap({model, spec, 3}, {points, responses, extractor, noise, transform, true, covariance},
                         {2});
}

/// A parameter whose square alone is measured, and one that is measured as it is.
NetworkMapTraining trainOnSquares(Index count, NetworkHead head) {
  const MatrixXd points = samplePairs(count);
  MatrixXd responses = points;
  responses.row(0) = points.row(0).cwiseAbs2();
  return trainOnPairs(points, responses, head);
}

double calcShareWithin(const NetworkMapTraining& trained, double probability) {
  int held = 0;
  for (std::size_t i = 0; i < trained.held_out.mixtures.size(); ++i) {
    const double truth = trained.held_out_truth(0, static_cast<Index>(i));
    held += calcCredibility(takeMarginal(trained.held_out.mixtures[i], 0), truth) < probability ? 1 : 0;
  }
  return static_cast<double>(held) / static_cast<double>(trained.held_out.mixtures.size());
}

TEST(NetworkMap, OfAMixtureKnowsBothAnswers) {
  const NetworkMapTraining mixed = trainOnSquares(20000, NetworkHead::kMixture);
  EXPECT_TRUE(mixed.warnings.empty());
  ASSERT_EQ(mixed.held_out.mixtures.size(), static_cast<std::size_t>(mixed.held_out.mean.cols()));
  EXPECT_NEAR(calcShareWithin(mixed, 0.5), 0.5, 0.05);
  EXPECT_NEAR(calcShareWithin(mixed, 0.95), 0.95, 0.025);
  const Estimates at = mixed.map.predict(Eigen::Vector2d(0.36, 0.5), MatrixXd(0, 1));
  const Intervals sets = findHighestDensity(takeMarginal(at.mixtures.front(), 0), 0.95);
  ASSERT_EQ(sets.size(), 2U);
  EXPECT_NEAR(0.5 * (sets[0].first + sets[0].second), -0.6, 0.02);
  EXPECT_NEAR(0.5 * (sets[1].first + sets[1].second), 0.6, 0.02);
  EXPECT_EQ(findHighestDensity(takeMarginal(at.mixtures.front(), 1), 0.95).size(), 1U);
  EXPECT_NEAR(at.mean(1, 0), 0.5, 0.02);
}

TEST(NetworkMap, OfOneNormalDistributionSaysWhereItsAnswersAreNone) {
  const NetworkMapTraining normal = trainOnSquares(20000, NetworkHead::kGaussian);
  ASSERT_EQ(normal.warnings.size(), 1U);
  EXPECT_NE(normal.warnings[0].find("side: 50 % intervals"), std::string::npos) << normal.warnings[0];
  EXPECT_NE(normal.warnings[0].find("head=mixture, components=4"), std::string::npos);
}

TEST(NetworkMap, OfAMixtureSaysWhereItHasTooFewComponents) {
  const MatrixXd points = samplePairs(20000);
  MatrixXd squares = points.cwiseAbs2();
  squares.row(1) = (2.0 * points.row(1).array() - 1.0).square();  // four answers
  const std::vector<std::string> warnings = trainOnPairs(points, squares, NetworkHead::kMixture, 2).warnings;
  ASSERT_FALSE(warnings.empty());
  EXPECT_NE(warnings.front().find("mixtures of 2 normal distributions"), std::string::npos)
      << warnings.front();
  EXPECT_NE(warnings.front().find("components=4"), std::string::npos) << warnings.front();
}

/// Of two parameters whose sum alone is measured, the posterior is uniform: its ends are those of the bounds.
MatrixXd sumPairs(const MatrixXd& points) {
  const Eigen::RowVectorXd sum = points.row(0) + 2.0 * points.row(1);
  return sum.replicate(2, 1);
}

TEST(NetworkMap, HasIntervalsThatHoldWhatTheySayWhereErrorsAreNotNormal) {
  const MatrixXd points = samplePairs(20000);
  const NetworkMapTraining trained = trainOnPairs(points, sumPairs(points), NetworkHead::kGaussian);
  ASSERT_TRUE(trained.map.validation.interval_factors.isGiven());
  const Index tests = 5000;
  const MatrixXd truth = samplePairs(20000 + tests).rightCols(tests);
  const Estimates found = trained.map.predict(sumPairs(truth), MatrixXd(0, tests));
  for (Index p = 0; p < 2; ++p) {
    const Eigen::ArrayXd depths = calcDepths(found, truth, p);
    EXPECT_GT((depths < kNormal95).cast<double>().mean(), 0.965);  // what normal distributions say
    EXPECT_NEAR((depths < found.interval_factors.get(p).of50).cast<double>().mean(), 0.5, 0.03);
    EXPECT_NEAR((depths < found.interval_factors.get(p).of95).cast<double>().mean(), 0.95, 0.015);
  }
}

TEST(NetworkMap, SaysWhereAFewOfItsErrorsAreLarge) {
  const MatrixXd points = samplePairs(20000);
  MatrixXd responses = points;
  for (Index j = 0; j < points.cols(); j += 23) {
    responses(0, j) += 0.5;
  }
  const NetworkMapTraining trained = trainOnPairs(points, responses, NetworkHead::kGaussian);
  ASSERT_EQ(trained.warnings.size(), 1U);
  EXPECT_NE(trained.warnings[0].find("side: 50 % intervals"), std::string::npos) << trained.warnings[0];
  EXPECT_NE(trained.warnings[0].find("a few errors are much larger"), std::string::npos);
}

}  // namespace
}  // namespace twinmap
