#include "framework/estimation/network/online_network.hpp"

#include <gtest/gtest.h>

#include "framework/estimation/estimator.hpp"
#include "kernels/linalg/decompositions.hpp"
#include "kernels/linalg/paired_matrix.hpp"

namespace twinmap {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

NetworkMap makeExample() {
  NetworkMap map;
  map.inputs = {VectorXd::Random(5),
                linalg::roundToHalves(MatrixXd::Random(2, 5)),
                {VectorXd::Random(1), VectorXd::Constant(1, 2.0)}};
  map.center = VectorXd::Random(2);
  map.half_width = VectorXd::Constant(2, 0.5);
  network::Network network;
  network.offset = VectorXd::Random(2);
  network.skip = MatrixXd::Random(2, 3);
  network.scale = VectorXd::Constant(2, 0.3);
  network.layers = {{MatrixXd::Random(4, 3), VectorXd::Random(4)},
                    {MatrixXd::Random(5, 4), VectorXd::Random(5)}};
  map.members = {{network, {}}};
  map.validation.stddev_scale = Eigen::Vector2d(1.0, 1.5);
  map.validation.residual_correlation = MatrixXd::Identity(2, 2);
  return map;
}

/// Two networks, whose last layers are known by a distribution.
NetworkMap makeBayesianExample() {
  NetworkMap map = makeExample();
  network::Member& member = map.members.front();
  const MatrixXd root = MatrixXd::Random(10, 10);
  member.last_layer = linalg::calcCholesky(root * root.transpose() + MatrixXd::Identity(10, 10)).lower;
  map.members.push_back(member);
  map.members.back().network.offset.array() += 0.2;
  return map;
}

/// Of measurements so many times as far away as the map's own.
void expectThePredictionsOf(const std::shared_ptr<const NetworkMap>& map, double far = 1.0) {
  const OnlineNetwork online(map);
  OnlineNetwork::Workspace workspace(online);
  const MatrixXd features = far * MatrixXd::Random(5, 3), known = MatrixXd::Random(1, 3);
  const Estimates expected = map->predict(features, known);
  const MatrixXd inputs = online.makeInputs(features, known);
  for (Eigen::Index i = 0; i < 3; ++i) {
    const Estimate& inference = online.infer(features.col(i), known.col(i), workspace);
    EXPECT_LT((inference.mean - expected.mean.col(i)).norm(), 1e-13);
    EXPECT_LT((inference.stddev - expected.stddev.col(i)).norm(), 1e-13);
    EXPECT_LT((inference.inputs - inputs.col(i)).norm(), 1e-13);
  }
  EXPECT_EQ(workspace.findExplanation(), nullptr);
  EXPECT_TRUE(online.isCalibrated());
  EXPECT_THROW(online.predict(MatrixXd::Zero(4, 1), MatrixXd::Zero(1, 1), 1), std::invalid_argument);
}

TEST(OnlineNetwork, InfersWhatTheMapPredicts) {
  expectThePredictionsOf(std::make_shared<const NetworkMap>(makeExample()));
}

TEST(OnlineNetwork, SaysHowFarIntervalsReach) {
  NetworkMap map = makeExample();
  map.validation.interval_factors = {Eigen::Vector2d(0.8, 0.7), Eigen::Vector2d(1.6, 2.0)};
  const OnlineNetwork online(std::make_shared<const NetworkMap>(map));
  OnlineNetwork::Workspace workspace(online);
  const MatrixXd features = MatrixXd::Random(5, 3), known = MatrixXd::Random(1, 3);
  EXPECT_EQ(online.infer(features.col(0), known.col(0), workspace).interval_factors.get(0).of95, 1.6);
  for (const Estimates& all : {online.predict(features, known, 2), map.predict(features, known)}) {
    ASSERT_EQ(all.interval_factors.of50.cols(), 3);
    EXPECT_EQ(all.interval_factors.get(1, 2).of50, 0.7);
  }
}

TEST(OnlineNetwork, NeverAnswersWiderThanTheBounds) {
  NetworkMap map = makeExample();
  map.members.front().network.layers.back().biases.segment(2, 2).setConstant(
      -3.0);  // logarithms of precision
  const MatrixXd features = 30.0 * MatrixXd::Random(5, 20), known = MatrixXd::Random(1, 20);
  EXPECT_LE(map.predict(features, known).stddev.maxCoeff(), 0.5);
  expectThePredictionsOf(std::make_shared<const NetworkMap>(std::move(map)), 30.0);
}

TEST(OnlineNetwork, OfSeveralBayesianNetworksInfersWhatTheMapPredicts) {
  expectThePredictionsOf(std::make_shared<const NetworkMap>(makeBayesianExample()));
}

}  // namespace
}  // namespace twinmap
