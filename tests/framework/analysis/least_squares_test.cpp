#include "framework/analysis/least_squares.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "framework/analysis/linear_map.hpp"
#include "tests/framework/support/linear_simulator.hpp"
#include "tests/lu.hpp"

namespace twinmap::testing {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd makeLinearResponse() {
  MatrixXd matrix(4, 2);
  matrix << 1, 2, 3, -1, 0.5, 0.5, -2, 1;
  return matrix;
}

MatrixXd makeNoise() {
  VectorXd variance(4);
  variance << 0.01, 0.04, 0.02, 0.09;
  return variance.asDiagonal();
}

class LinearFit : public ::testing::Test {
 protected:
  LeastSquaresFit fit(const VectorXd& measured, const VectorXd& start, int max_simulations = 500) {
    return fitLeastSquares(simulator_, {extractor_, noise_, parameters_, measured}, start, max_simulations);
  }

  LinearSimulator simulator_{makeLinearResponse()};
  FeatureExtractor extractor_{makeAllFeatures(simulator_), simulator_.getLayout()};
  NoiseWhitener noise_{makeNoise()};
  std::vector<ParameterSpec> parameters_ = makeParameters(2, -3.0, 5.0);
};

TEST_F(LinearFit, IsTheWeightedLeastSquaresSolution) {
  VectorXd measured(4);
  measured << -1.6, 3.1, -0.2, -2.5;
  const MatrixXd weights = test::calcInverse(makeNoise());
  const MatrixXd information = makeLinearResponse().transpose() * weights * makeLinearResponse();
  const VectorXd expected =
      test::calcInverse(information) * makeLinearResponse().transpose() * weights * measured;
  const LeastSquaresFit found = fit(measured, Eigen::Vector2d(1.0, 1.0));
  ASSERT_TRUE(found.converged) << found.message;
  EXPECT_LT((found.parameters - expected).norm(), 1e-4);  // a hundredth of the stddev
  EXPECT_LT((found.information - 64.0 * information).norm(), 1e-6 * found.information.norm());  // width 8
  const VectorXd residual = makeLinearResponse() * expected - measured;
  EXPECT_NEAR(found.chi_square, residual.dot(weights * residual), 1e-4);
}

TEST_F(LinearFit, SearchesTheUnknownWithTheInputsHeld) {
  const VectorXd measured = makeLinearResponse() * Eigen::Vector2d(1.0, 4.0);
  const std::vector<ParameterSpec> unknown{parameters_[0]};
  const LeastSquaresFit found =
      fitLeastSquares(simulator_, {extractor_, noise_, unknown, measured, VectorXd::Constant(1, 4.0)},
                      VectorXd::Zero(1), 500);
  ASSERT_TRUE(found.converged) << found.message;
  ASSERT_EQ(found.parameters.size(), 1);
  EXPECT_NEAR(found.parameters[0], 1.0, 1e-4);
}

TEST_F(LinearFit, StaysWithinTheBounds) {
  const VectorXd measured = makeLinearResponse() * Eigen::Vector2d(7.0, 1.0);  // the first beyond its bound 5
  const LeastSquaresFit found = fit(measured, Eigen::Vector2d(5.0, 1.0));
  EXPECT_LE(found.parameters[0], 5.0);
  EXPECT_NEAR(found.parameters[0], 5.0, 0.02);
}

TEST_F(LinearFit, SaysThatItRanOutOfSimulations) {
  const LeastSquaresFit found =
      fit(makeLinearResponse() * Eigen::Vector2d(2.0, 1.0), Eigen::Vector2d(-2.0, -2.0), 3);
  EXPECT_FALSE(found.converged);
  EXPECT_NE(found.message.find("simulations"), std::string::npos);
}

TEST_F(LinearFit, AFailingStartIsReportedAndAFailureOnTheWayIsAvoided) {
  simulator_ = LinearSimulator(makeLinearResponse(), 2.0);
  const VectorXd measured = makeLinearResponse() * Eigen::Vector2d(1.9, 1.0);
  const LeastSquaresFit failed = fit(measured, Eigen::Vector2d(4.0, 1.0));
  EXPECT_FALSE(failed.converged);
  EXPECT_EQ(failed.message, "too much");
  EXPECT_TRUE(fit(measured, Eigen::Vector2d(-2.5, 4.0)).converged);
}

TEST(LinearMap, InvertsWhatIsLinear) {
  const MatrixXd points = MatrixXd::Random(2, 50);
  LabelledFeatures samples;
  samples.features = (makeLinearResponse() * points).array() + 3.0;
  samples.parameters = points;
  const LinearMap map = trainLinearMap({}, samples);
  const Estimates predictions = map.predict(samples.features, {});
  EXPECT_LT((predictions.mean - points).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_LT(predictions.stddev.maxCoeff(), 1e-12);
}

TEST(LinearMap, SeesKnownInputs) {
  LabelledFeatures samples;
  samples.parameters = MatrixXd::Random(1, 50);
  samples.inputs = MatrixXd::Random(1, 50);
  samples.features = 2.0 * samples.parameters + 5.0 * samples.inputs;
  const Estimates predictions = trainLinearMap({}, samples).predict(samples.features, samples.inputs);
  EXPECT_LT((predictions.mean - samples.parameters).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(LinearMap, ItsStddevIsThatOfWhatTheFeaturesDoNotExplain) {
  LabelledFeatures samples;
  samples.features = MatrixXd::Random(1, 4000);
  const MatrixXd rest = MatrixXd::Random(1, 4000);  // uniform on [-1, 1]
  samples.parameters = 3.0 * samples.features + rest;
  const LinearMap map = trainLinearMap({}, samples);
  EXPECT_NEAR(map.slopes(0, 0), 3.0, 0.05);
  EXPECT_NEAR(map.stddev[0], 1.0 / std::sqrt(3.0), 0.02);
}

}  // namespace
}  // namespace twinmap::testing
