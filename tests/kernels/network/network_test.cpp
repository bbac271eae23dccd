#include "kernels/network/network.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "kernels/linalg/decompositions.hpp"
#include "kernels/network/backpropagation.hpp"
#include "kernels/network/predictor.hpp"
#include "tests/kernels/golden/network_golden.hpp"
#include "tests/kernels/network/waves.hpp"

namespace twinmap::network {
namespace {

/// The lower triangle L = D (1 + A) of the precision, written out.
MatrixXd makeLower(const VectorXd& head, Index p) {
  MatrixXd lower = MatrixXd::Identity(p, p);
  for (Index j = 1; j < p; ++j) {
    for (Index i = 0; i < j; ++i) {
      lower(j, i) = head[getTriangleRow(p, j, i)];
    }
  }
  return head.segment(p, p).array().exp().matrix().asDiagonal() * lower;
}

TEST(HeadDensity, IsThatOfTheNormalDistributionWithItsMoments) {
  const Index p = 4;
  const VectorXd head = makeWave(countHeadOutputs(p), 1, 5), target = makeWave(p, 1, 6);
  const MatrixXd lower = makeLower(head, p);
  const VectorXd error = target - head.head(p);
  const double expected = 0.5 * error.dot(lower * (lower.transpose() * error)) -
                          lower.diagonal().array().log().sum() + 0.5 * p * std::log(2.0 * M_PI);
  EXPECT_NEAR(calcLoss(head, target), expected, 1e-13);
}

TEST(HeadDensity, HasTheMomentsOfItsPrecisionOfAnyNumberOfTargets) {
  for (Index p = 1; p <= 10; ++p) {
    const VectorXd head = makeWave(countHeadOutputs(p), 1, 5);
    const MatrixXd lower = makeLower(head, p);
    VectorXd mean(p);
    MatrixXd covariance(p, p), buffer(p, p);
    calcMoments(head, mean, covariance, buffer);
    EXPECT_EQ(mean, head.head(p));
    EXPECT_EQ(covariance, MatrixXd(covariance.transpose()));
    const MatrixXd expected = linalg::solveCholesky(lower, MatrixXd::Identity(p, p));
    EXPECT_LT((covariance - expected).norm(), 1e-12 * expected.norm()) << p;
  }
}

TEST(HeadDensity, GrowsLinearlyBeyondTheLargestResidual) {
  const VectorXd head = VectorXd::Zero(2);
  const auto calcAt = [&](double target) { return calcLoss(head, VectorXd::Constant(1, target)); };
  EXPECT_NEAR(calcAt(8.0) - calcAt(7.0), kLargestResidual, 1e-12);
  EXPECT_NEAR(calcAt(6.0 + 1e-9), calcAt(6.0), 1e-7);
  MatrixXd gradient(2, 1);
  calcLoss(head, VectorXd::Constant(1, -100.0), gradient);
  EXPECT_DOUBLE_EQ(gradient(0), kLargestResidual);
}

TEST(HeadDensity, OfSeveralComponentsIsTheLogarithmOfTheirSum) {
  const Index p = 3, components = 2, outputs = countNormalOutputs(p);
  const VectorXd head = makeWave(countHeadOutputs(p, components), 1, 5), target = makeWave(p, 1, 6);
  ASSERT_EQ(head.size(), 2 + 2 * outputs);
  const double first = std::exp(head[0]) / (std::exp(head[0]) + std::exp(head[1]));
  const double density = first * std::exp(-calcLoss(head.segment(2, outputs), target)) +
                         (1.0 - first) * std::exp(-calcLoss(head.segment(2 + outputs, outputs), target));
  EXPECT_NEAR(calcLoss(head, target), -std::log(density), 1e-13);
}

TEST(HeadDensity, OfEqualComponentsIsThatOfOne) {
  const Index p = 3, outputs = countNormalOutputs(p);
  const VectorXd one = makeWave(outputs, 1, 5), target = 20.0 * makeWave(p, 1, 6);
  VectorXd head(countHeadOutputs(p, 4));
  head << 1.0, -2.0, 0.5, 3.0, one, one, one, one;
  EXPECT_NEAR(calcLoss(head, target), calcLoss(one, target), 1e-12 * calcLoss(one, target));
}

TEST(Backpropagation, AgreesWithNumpy) {
  const Network network = makeWaveNetwork();
  Gradient gradient = makeZeros(network);
  PassWorkspace workspace;
  const MatrixXd inputs = makeWave(kInputs, kSamples, 30), targets = 3.0 * makeWave(kTargets, kSamples, 31);
  EXPECT_NEAR(calcLossAndGradient(network, inputs, targets, gradient, workspace), golden::kLoss,
              1e-12 * golden::kLoss);
  for (std::size_t k = 0; k < gradient.layers.size(); ++k) {
    const MatrixXd& weights = gradient.layers[k].weights;
    for (Index row = 0; row < weights.rows(); ++row) {
      for (Index col = 0; col < weights.cols(); ++col) {
        const double expected =
            golden::kDerivatives[2 * k][static_cast<std::size_t>(row * weights.cols() + col)];
        EXPECT_NEAR(weights(row, col), expected, 1e-11 * (1.0 + std::abs(expected)));
      }
      const double expected = golden::kDerivatives[2 * k + 1][static_cast<std::size_t>(row)];
      EXPECT_NEAR(gradient.layers[k].biases[row], expected, 1e-11 * (1.0 + std::abs(expected)));
    }
  }
  EXPECT_DOUBLE_EQ(calcLoss(network, inputs, targets, workspace),
                   calcLossAndGradient(network, inputs, targets, gradient, workspace));
}

class BackpropagationOf : public testing::TestWithParam<Index> {};

INSTANTIATE_TEST_SUITE_P(Components, BackpropagationOf, testing::Values(1, 3));

TEST_P(BackpropagationOf, AgreesWithFiniteDifferences) {
  Network network = makeWaveNetwork(GetParam());
  Gradient gradient = makeZeros(network);
  PassWorkspace workspace;
  const MatrixXd inputs = makeWave(kInputs, kSamples, 30), targets = makeWave(kTargets, kSamples, 31);
  calcLossAndGradient(network, inputs, targets, gradient, workspace);
  constexpr double kStep = 1e-6;
  for (std::size_t k = 0; k < gradient.layers.size(); ++k) {
    for (Index i = 0; i < gradient.layers[k].weights.size(); ++i) {
      double& weight = network.layers[k].weights.data()[i];
      const double held = weight;
      weight = held + kStep;
      const double above = calcLoss(network, inputs, targets, workspace);
      weight = held - kStep;
      const double below = calcLoss(network, inputs, targets, workspace);
      weight = held;
      EXPECT_NEAR(gradient.layers[k].weights.data()[i], (above - below) / (2.0 * kStep), 1e-5);
    }
  }
}

TEST_P(BackpropagationOf, TheRegressionAgreesWithFiniteDifferences) {
  Network network = makeWaveNetwork(GetParam());
  network.products = {2, 0};
  network.skip = makeWave(kTargets, kInputs + 3, 21);
  Gradient gradient = makeZeros(network);
  PassWorkspace workspace;
  const MatrixXd inputs = makeWave(kInputs, kSamples, 30), targets = makeWave(kTargets, kSamples, 31);
  calcLossAndGradient(network, inputs, targets, gradient, workspace);
  constexpr double kStep = 1e-6;
  for (Index i = 0; i < kTargets; ++i) {
    for (Index j = 0; j < network.skip.cols(); ++j) {
      const double held = network.skip(i, j), change = kStep * network.scale[i];
      network.skip(i, j) = held + change;
      const double above = calcLoss(network, inputs, targets, workspace);
      network.skip(i, j) = held - change;
      const double below = calcLoss(network, inputs, targets, workspace);
      network.skip(i, j) = held;
      EXPECT_NEAR(gradient.skip(i, j), (above - below) / (2.0 * kStep), 1e-5);
    }
  }
}

TEST(MakeNetwork, BeginsAsTheRidgeRegression) {
  const MatrixXd inputs = makeWave(3, 40, 1);
  MatrixXd targets = MatrixXd::Constant(2, 40, 5.0);
  targets.row(0) += 2.0 * inputs.row(1);
  targets.row(1) += 0.1 * makeWave(1, 40, 9);
  const Network network = makeNetwork(inputs, targets, {{4}, 1e-12, {}}, [](Index) { return 1.0; });
  EXPECT_NEAR(network.skip(0, 1), 2.0, 1e-9);
  const Predictor predictor(network);
  Predictor::Workspace workspace(predictor);
  predictor.predict(inputs.col(7), workspace);
  EXPECT_NEAR(workspace.mean[0], targets(0, 7), 1e-9);
  EXPECT_DOUBLE_EQ(workspace.stddev[1], network.scale[1]);
  MatrixXd rest = (targets - network.skip * inputs).colwise() - network.offset;
  EXPECT_NEAR(network.scale[1], std::sqrt(rest.row(1).squaredNorm() / 40.0), 1e-15);
}

TEST(MakeNetwork, TakesProductsOfTheFirstInputs) {
  const MatrixXd inputs = makeWave(3, 60, 1);
  const auto x = inputs.row(0).array(), y = inputs.row(1).array(), z = inputs.row(2).array();
  const MatrixXd targets = (2.0 * z + 3.0 * x * y - y * y + 0.5 * x - 2.0 * x * y * y).matrix();
  const Network network = makeNetwork(inputs, targets, {{4}, 1e-13, {2, 2}}, [](Index) { return 1.0; });
  EXPECT_EQ(network.skip.cols(), 3 + 3 + 4);
  const MatrixXd found = (network.skip * makeTerms(inputs, {2, 2})).colwise() + network.offset;
  EXPECT_LT((found - targets).norm(), 1e-8);
  const Predictor predictor(network);
  Predictor::Workspace workspace(predictor);
  predictor.predict(inputs.col(5), workspace);
  EXPECT_NEAR(workspace.mean[0], targets(0, 5), 1e-8);
}

TEST(NetworkPredictor, IsTheNetworkWithItsLayersWrittenOut) {
  const Network network = roundWeights(makeWaveNetwork());
  const Predictor predictor(network);
  Predictor::Workspace workspace(predictor);
  const VectorXd input = makeWave(kInputs, 1, 33);
  VectorXd values = input;
  for (std::size_t k = 0; k < network.layers.size(); ++k) {
    values = network.layers[k].weights * values + network.layers[k].biases;
    if (k + 1 < network.layers.size()) {
      values = values.array() / (1.0 + (-values.array()).exp());
    }
  }
  const MatrixXd lower = makeLower(values, kTargets);
  const MatrixXd units = network.scale.asDiagonal();
  const MatrixXd covariance =
      units * linalg::solveCholesky(lower, MatrixXd::Identity(kTargets, kTargets)) * units;
  const VectorXd mean = network.offset + network.skip * input + units * values.head(kTargets);
  for (int again = 0; again < 2; ++again) {
    predictor.predict(input, workspace);
    EXPECT_LT((workspace.mean - mean).norm(), 1e-13);
    EXPECT_LT((workspace.covariance - covariance).norm(), 1e-12 * covariance.norm());
    EXPECT_LT((workspace.stddev.cwiseAbs2() - covariance.diagonal()).norm(), 1e-12 * covariance.norm());
  }
}

TEST(NetworkPredictor, MixesItsComponents) {
  const Index components = 3;
  const Network network = makeWaveNetwork(components);
  const Predictor predictor(network);
  Predictor::Workspace workspace(predictor);
  predictor.predict(makeWave(kInputs, 1, 33), workspace);
  EXPECT_NEAR(workspace.weights.sum(), 1.0, 1e-15);
  EXPECT_LT((workspace.means * workspace.weights - workspace.mean).norm(), 1e-13);
  MatrixXd covariance = MatrixXd::Zero(kTargets, kTargets);
  for (Index c = 0; c < components; ++c) {
    // a network of this component alone
    Network one = network;
    const Index first = getComponentRow(kTargets, components, c), outputs = countNormalOutputs(kTargets);
    one.layers.back() = {network.layers.back().weights.middleRows(first, outputs),
                         network.layers.back().biases.segment(first, outputs)};
    const Predictor alone(one);
    Predictor::Workspace of_one(alone);
    alone.predict(makeWave(kInputs, 1, 33), of_one);
    EXPECT_LT((workspace.means.col(c) - of_one.mean).norm(), 1e-13);
    EXPECT_LT((workspace.covariances[static_cast<std::size_t>(c)] - of_one.covariance).norm(), 1e-12);
    const VectorXd apart = of_one.mean - workspace.mean;
    covariance += workspace.weights[c] * (of_one.covariance + apart * apart.transpose());
  }
  EXPECT_LT((workspace.covariance - covariance).norm(), 1e-12 * covariance.norm());
}

}  // namespace
}  // namespace twinmap::network
