#include "kernels/network/ensemble.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "kernels/linalg/decompositions.hpp"
#include "kernels/network/backpropagation.hpp"
#include "tests/kernels/network/waves.hpp"

namespace twinmap::network {
namespace {

MatrixXd makeTargets() {
  return 0.4 * makeWave(kTargets, kSamples, 31);
}

MatrixXd makeInputs() {
  return makeWave(kInputs, kSamples, 30);
}

/// What one network alone says.
Predictor::Workspace predictAlone(const Network& network, const VectorXd& inputs) {
  const Predictor predictor(network);
  Predictor::Workspace workspace(predictor);
  predictor.predict(inputs, workspace);
  return workspace;
}

TEST(Ensemble, OfOneNetworkSaysWhatTheNetworkSays) {
  const VectorXd inputs = makeWave(kInputs, 1, 40);
  const EnsemblePredictor ensemble({{makeWaveNetwork(), {}}});
  EnsemblePredictor::Workspace workspace(ensemble);
  const Predictor::Workspace alone = predictAlone(makeWaveNetwork(), inputs);
  EXPECT_EQ(ensemble.predict(inputs, workspace).mean, alone.mean);
  EXPECT_EQ(ensemble.predict(inputs, workspace).covariance, alone.covariance);
}

TEST(Ensemble, OfSeveralHasTheMomentsOfTheirMixture) {
  const VectorXd inputs = makeWave(kInputs, 1, 40);
  Network other = makeWaveNetwork();
  other.offset.array() += 0.3;
  other.layers.back().biases.array() += 0.1;
  const Predictor::Workspace a = predictAlone(makeWaveNetwork(), inputs), b = predictAlone(other, inputs);
  const EnsemblePredictor ensemble({{makeWaveNetwork(), {}}, {other, {}}});
  EnsemblePredictor::Workspace workspace(ensemble);
  const Predictor::Workspace& mixed = ensemble.predict(inputs, workspace);
  EXPECT_LT((mixed.mean - 0.5 * (a.mean + b.mean)).norm(), 1e-14);
  const auto square = [](const Predictor::Workspace& one) {
    return MatrixXd(one.covariance + one.mean * one.mean.transpose());
  };
  const MatrixXd covariance = 0.5 * (square(a) + square(b)) - mixed.mean * mixed.mean.transpose();
  EXPECT_LT((mixed.covariance - covariance).norm(), 1e-12 * covariance.norm());
  EXPECT_LT((mixed.stddev - mixed.covariance.diagonal().cwiseSqrt()).norm(), 1e-15);
}

TEST(LastLayerOfANetwork, IsSeenAsItsLossSeesIt) {
  Network network = makeWaveNetwork();
  network.scale *= 5.0;  // no residual is clamped
  network.layers.back().weights *= 0.2;
  network.layers.back().biases *= 0.2;
  const MatrixXd inputs = makeInputs(), targets = makeTargets();
  const LinearObservations observed = observeLastLayer(network, inputs, targets);
  const MatrixXd weights = getMeanWeights(network);
  double loss = 0.0;
  for (Index i = 0; i < kSamples; ++i) {
    const MatrixXd& precision = observed.precisions[std::size_t(i)];
    const VectorXd rest = observed.targets.col(i) - weights * observed.inputs.col(i);
    const double residual = rest.dot(precision * rest);
    ASSERT_LT(residual, kLargestResidual * kLargestResidual);  // beyond, the loss is not a normal density's
    loss += 0.5 * residual - linalg::calcCholesky(precision).lower.diagonal().array().log().sum() +
            0.5 * double(kTargets) * std::log(2.0 * M_PI);
  }
  PassWorkspace pass;
  EXPECT_NEAR(loss, calcLoss(network, inputs, targets, pass), 1e-10 * std::abs(loss));
}

TEST(LastLayerOfANetwork, AddsWhatItsSamplesLeaveOpen) {
  const Network network = roundWeights(makeWaveNetwork());
  const MatrixXd inputs = makeInputs(), targets = makeTargets();
  const LinearObservations observed = observeLastLayer(network, inputs, targets);
  const Member member = makeBayesian(network, inputs, targets);
  const VectorXd measured = makeWave(kInputs, 1, 40);
  const EnsemblePredictor ensemble({member});
  EnsemblePredictor::Workspace workspace(ensemble);
  const Predictor::Workspace& answer = ensemble.predict(measured, workspace);
  // the precision by its definition, and the last hidden layer by observing the measurement
  const Index size = kTargets * observed.inputs.rows();
  MatrixXd precision = LastLayerEvidence(observed).maximise() * MatrixXd::Identity(size, size);
  const auto makeDesign = [&](const VectorXd& f) {
    MatrixXd design(kTargets, size);
    for (Index k = 0; k < f.size(); ++k) {
      design.middleCols(k * kTargets, kTargets) = f[k] * MatrixXd::Identity(kTargets, kTargets);
    }
    return design;
  };
  for (Index i = 0; i < kSamples; ++i) {
    const MatrixXd design = makeDesign(observed.inputs.col(i));
    precision += design.transpose() * observed.precisions[std::size_t(i)] * design;
  }
  const LinearObservations here = observeLastLayer(network, measured, VectorXd::Zero(kTargets));
  const MatrixXd design = makeDesign(here.inputs.col(0));
  const MatrixXd lower = linalg::calcCholesky(precision).lower;
  const VectorXd& scale = member.network.scale;
  const MatrixXd open =
      scale.asDiagonal() * design * linalg::solveCholesky(lower, design.transpose()) * scale.asDiagonal();
  const Predictor::Workspace alone = predictAlone(member.network, measured);
  EXPECT_LT((answer.covariance - alone.covariance - open).norm(), 1e-8 * open.norm());
  EXPECT_EQ(answer.mean, alone.mean);
}

}  // namespace
}  // namespace twinmap::network
