#include "kernels/network/last_layer.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "kernels/linalg/decompositions.hpp"
#include "tests/kernels/network/waves.hpp"

namespace twinmap::network {
namespace {

constexpr Index kOutputs = 2, kFeatures = 4, kObservations = 9;

LinearObservations makeObservations() {
  LinearObservations observations{
      makeWave(kFeatures, kObservations, 1), makeWave(kOutputs, kObservations, 2), {}};
  for (Index i = 0; i < kObservations; ++i) {
    const MatrixXd root = makeWave(kOutputs, kOutputs, 3.0 + double(i));
    observations.precisions.push_back(root * root.transpose() + 0.5 * MatrixXd::Identity(kOutputs, kOutputs));
  }
  return observations;
}

/// The matrix X of W f = X vec(W).
MatrixXd makeDesign(const VectorXd& inputs) {
  MatrixXd design = MatrixXd::Zero(kOutputs, kOutputs * kFeatures);
  for (Index k = 0; k < kFeatures; ++k) {
    design.middleCols(k * kOutputs, kOutputs) = inputs[k] * MatrixXd::Identity(kOutputs, kOutputs);
  }
  return design;
}

/// All observations below each other: designs and covariance of the errors.
struct Stacked {
  MatrixXd design, noise;
  VectorXd targets;
};

Stacked stack(const LinearObservations& observations) {
  const Index rows = kOutputs * kObservations;
  Stacked stacked{MatrixXd(rows, kOutputs * kFeatures), MatrixXd::Zero(rows, rows),
                  observations.targets.reshaped()};
  for (Index i = 0; i < kObservations; ++i) {
    stacked.design.middleRows(i * kOutputs, kOutputs) = makeDesign(observations.inputs.col(i));
    const MatrixXd lower = linalg::calcCholesky(observations.precisions[std::size_t(i)]).lower;
    stacked.noise.block(i * kOutputs, i * kOutputs, kOutputs, kOutputs) =
        linalg::solveCholesky(lower, MatrixXd::Identity(kOutputs, kOutputs));
  }
  return stacked;
}

MatrixXd invert(const MatrixXd& matrix) {
  return linalg::solveCholesky(linalg::calcCholesky(matrix).lower,
                               MatrixXd::Identity(matrix.rows(), matrix.rows()));
}

TEST(LastLayer, PosteriorIsThatOfDenseAlgebra) {
  constexpr double kAlpha = 0.3;
  const LinearObservations observations = makeObservations();
  const Stacked stacked = stack(observations);
  // the other way round: conditioning the joint normal distribution of weights and targets
  const MatrixXd prior = MatrixXd::Identity(stacked.design.cols(), stacked.design.cols()) / kAlpha;
  const MatrixXd gain = prior * stacked.design.transpose() *
                        invert(stacked.design * prior * stacked.design.transpose() + stacked.noise);
  const VectorXd mean = gain * stacked.targets;
  const MatrixXd covariance = prior - gain * stacked.design * prior;
  const LastLayerPosterior posterior = calcLastLayerPosterior(observations, kAlpha);
  EXPECT_LT((posterior.mean.reshaped() - mean).norm(), 1e-10 * mean.norm());
  const VectorXd inputs = makeWave(kFeatures, 1, 40);
  const MatrixXd design = makeDesign(inputs);
  EXPECT_LT((posterior.calcCovariance(inputs) - design * covariance * design.transpose()).norm(),
            1e-10 * covariance.norm());
}

TEST(LastLayer, EvidenceIsTheDensityOfTheTargets) {
  const LinearObservations observations = makeObservations();
  const Stacked stacked = stack(observations);
  const LastLayerEvidence evidence(observations);
  const auto calcDensity = [&](double alpha) {
    const MatrixXd covariance = stacked.design * stacked.design.transpose() / alpha + stacked.noise;
    const MatrixXd lower = linalg::calcCholesky(covariance).lower;
    return -0.5 * linalg::solveLower(lower, stacked.targets).squaredNorm() -
           lower.diagonal().array().log().sum() - 0.5 * double(stacked.targets.size()) * std::log(2.0 * M_PI);
  };
  for (const double alpha : {1e-3, 0.3, 20.0}) {
    EXPECT_NEAR(evidence.calculate(alpha), calcDensity(alpha), 1e-9);
  }
  const double best = evidence.maximise();
  EXPECT_GE(evidence.calculate(best), evidence.calculate(1.02 * best));
  EXPECT_GE(evidence.calculate(best), evidence.calculate(best / 1.02));
}

TEST(LastLayer, WithoutObservationsIsThePrior) {
  const LinearObservations none{MatrixXd(kFeatures, 0), MatrixXd(kOutputs, 0), {}};
  const LastLayerPosterior posterior = calcLastLayerPosterior(none, 4.0);
  EXPECT_EQ(posterior.mean, MatrixXd::Zero(kOutputs, kFeatures));
  const VectorXd inputs = makeWave(kFeatures, 1, 40);
  EXPECT_LT((posterior.calcCovariance(inputs) -
             0.25 * inputs.squaredNorm() * MatrixXd::Identity(kOutputs, kOutputs))
                .norm(),
            1e-14);
}

}  // namespace
}  // namespace twinmap::network
