#include "framework/data/reduction/partial_least_squares.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "kernels/linalg/decompositions.hpp"
#include "tests/framework/data/features/normal_numbers.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

/// Ten features of variance 100 that say nothing, and two parameters seen in two others of variance 1.
LabelledFeatures hideParameters(int simulations, int replicates = 1) {
  LabelledFeatures samples;
  samples.replicates = replicates;
  samples.parameters = makeNormal(2, simulations, 1).replicate(1, replicates);
  samples.features.resize(12, simulations * replicates);
  samples.features.topRows(10) = 10.0 * makeNormal(10, simulations * replicates, 2);
  samples.features.bottomRows(2) = samples.parameters + 0.1 * makeNormal(2, simulations * replicates, 3);
  samples.parameters.row(1) *= 1e-4;
  return samples;
}

PartialLeastSquaresSpec makePartialLeastSquares(std::optional<int> components = {}) {
  return {{components}};
}

TEST(PartialLeastSquares, OneComponentOfOneTargetIsTheCovarianceByHand) {
  MatrixXd features(2, 4), target(1, 4);
  features << 1, -1, 2, -2, 1, 1, -1, -1;
  target << 1, -1, 3, -3;
  const PartialLeastSquares model = calcPartialLeastSquares(features, target, 1);
  const Eigen::Vector2d direction = model.rotations.col(0) * (model.rotations(0, 0) > 0 ? 1 : -1);
  EXPECT_NEAR(direction[0], 1.0, 1e-15);  // X y' = (14, 0)
  EXPECT_NEAR(direction[1], 0.0, 1e-15);
  EXPECT_NEAR(std::abs(model.loadings(0, 0)), 1.4, 1e-15);  // 14 / (1 + 1 + 4 + 4)
}

TEST(PartialLeastSquares, AllComponentsAreLeastSquares) {
  const LabelledFeatures samples = hideParameters(40);
  const MatrixXd x = samples.features.colwise() - samples.features.rowwise().mean().eval();
  const MatrixXd y = samples.parameters.colwise() - samples.parameters.rowwise().mean().eval();
  const PartialLeastSquares model = calcPartialLeastSquares(x, y, 12);
  const MatrixXd slopes = linalg::solveSemidefinite(x * x.transpose(), x * y.transpose()).transpose();
  EXPECT_LT((model.loadings * model.rotations.transpose() - slopes).norm(), 1e-10 * slopes.norm());
}

TEST(PartialLeastSquares, ScoresAreUncorrelatedOverTheSamples) {
  const LabelledFeatures samples = hideParameters(60);
  const MatrixXd scores = fitPartialLeastSquares(makePartialLeastSquares(5), samples).apply(samples.features);
  const MatrixXd covariance = scores * scores.transpose();
  const MatrixXd diagonal = covariance.diagonal().asDiagonal();
  EXPECT_LT((covariance - diagonal).norm(), 1e-11 * diagonal.norm());
}

TEST(PartialLeastSquares, AutomaticRankFindsTheDirectionsThatPredict) {
  const LabelledFeatures samples = hideParameters(400, 2);
  const MatrixXd projection = fitPartialLeastSquares(makePartialLeastSquares(), samples).projection;
  const MatrixXd errors = calcCrossValidationErrors(samples, 12, 10);
  const Index rank = projection.rows();
  EXPECT_LT(rank, 12);
  EXPECT_NEAR(errors.col(rank - 1).mean(), 0.02, 0.004);  // 0.1^2 for each parameter
  EXPECT_GT(errors.col(0).mean(), 0.1);
}

TEST(PartialLeastSquares, TheAutomaticRankOfPureNoiseIsOne) {
  LabelledFeatures samples = hideParameters(100);
  samples.features = makeNormal(12, 100, 9);
  EXPECT_EQ(fitPartialLeastSquares(makePartialLeastSquares(), samples).projection.rows(), 1);
}

/// Features that recognise the simulation predict its other draws perfectly, and no other simulation.
TEST(PartialLeastSquares, ReplicatesOfASimulationStayInOneFold) {
  constexpr Index kSimulations = 20;
  LabelledFeatures samples;
  samples.replicates = 2;
  samples.features = MatrixXd::Identity(kSimulations, kSimulations).replicate(1, 2);
  samples.parameters = makeNormal(1, kSimulations, 4).replicate(1, 2);
  EXPECT_GT(calcCrossValidationErrors(samples, 5, 5).minCoeff(), 0.2);
}

TEST(PartialLeastSquares, RefusesMoreComponentsThanThereAre) {
  LabelledFeatures samples = hideParameters(40);
  EXPECT_THROW(fitPartialLeastSquares(makePartialLeastSquares(13), samples), std::invalid_argument);
  samples.features.bottomRows(6) = samples.features.topRows(6);
  EXPECT_EQ(fitPartialLeastSquares(makePartialLeastSquares(6), samples).projection.rows(), 6);
  EXPECT_THROW(fitPartialLeastSquares(makePartialLeastSquares(7), samples), std::invalid_argument);
  samples.features.setConstant(3.0);
  EXPECT_THROW(fitPartialLeastSquares(makePartialLeastSquares(), samples), std::invalid_argument);
}

TEST(PartialLeastSquares, TwoSimulationsAreEnough) {
  EXPECT_EQ(fitPartialLeastSquares(makePartialLeastSquares(), hideParameters(2)).projection.rows(), 1);
}

}  // namespace
}  // namespace twinmap
