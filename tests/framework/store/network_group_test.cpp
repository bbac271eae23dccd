#include "framework/store/estimators/network_group.hpp"

#include <gtest/gtest.h>

#include "framework/base/files/temporary_folder.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

NetworkMap makeExample() {
  NetworkMap map;
  map.inputs = {VectorXd::Random(5), MatrixXd::Random(2, 5), {VectorXd::Random(1), VectorXd::Ones(1)}};
  map.center = VectorXd::Random(2);
  map.half_width = VectorXd::Constant(2, 0.5);
  network::Network network;
  network.offset = VectorXd::Random(2);
  network.skip = MatrixXd::Random(2, 3 + 3);
  network.products = {2, 0};
  network.scale = VectorXd::Constant(2, 0.3);
  network.layers = {{MatrixXd::Random(4, 3), VectorXd::Random(4)},
                    {MatrixXd::Random(5, 4), VectorXd::Random(5)}};
  map.members = {{network, {}}};
  return map;
}

void expectTheSameBitsBack(NetworkMap map) {
  const TemporaryFolder folder;
  {
    Hdf5Writer file(folder.getPath() / "map.h5");
    writeNetworkGroup(file, "/online/network", map);
    file.close();
  }
  NetworkMap read = readNetworkGroup(Hdf5Reader(folder.getPath() / "map.h5"), "/online/network");
  map.validation.stddev_scale = read.validation.stddev_scale = VectorXd::Ones(2);
  const MatrixXd features = MatrixXd::Random(5, 9), known = MatrixXd::Random(1, 9);
  const Estimates expected = map.predict(features, known), found = read.predict(features, known);
  EXPECT_EQ(found.mean, expected.mean);
  EXPECT_EQ(found.stddev, expected.stddev);
}

TEST(NetworkGroup, GivesANetworkThatInfersTheSameBits) {
  expectTheSameBitsBack(makeExample());
}

TEST(NetworkGroup, GivesABayesianNetworkThatInfersTheSameBits) {
  NetworkMap map = makeExample();
  const MatrixXd root = MatrixXd::Random(10, 10);
  map.members.front().last_layer =
      linalg::calcCholesky(root * root.transpose() + MatrixXd::Identity(10, 10)).lower;
  map.members.push_back(map.members.front());
  map.members.back().network.offset.array() += 0.2;
  expectTheSameBitsBack(map);
}

}  // namespace
}  // namespace twinmap
