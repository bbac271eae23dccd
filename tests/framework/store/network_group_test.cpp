#include "framework/store/network_group.hpp"

#include <gtest/gtest.h>

#include "framework/store/temporary_folder.hpp"

namespace twinmap {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

NetworkMap makeExample() {
  NetworkMap map;
  map.inputs = {VectorXd::Random(5), MatrixXd::Random(2, 5), {VectorXd::Random(1), VectorXd::Ones(1)}};
  map.center = VectorXd::Random(2);
  map.half_width = VectorXd::Constant(2, 0.5);
  map.network.offset = VectorXd::Random(2);
  map.network.skip = MatrixXd::Random(2, 3 + 3);
  map.network.products = {2, 0};
  map.network.scale = VectorXd::Constant(2, 0.3);
  map.network.layers = {{MatrixXd::Random(4, 3), VectorXd::Random(4)},
                        {MatrixXd::Random(5, 4), VectorXd::Random(5)}};
  return map;
}

TEST(NetworkGroup, GivesANetworkThatInfersTheSameBits) {
  const TemporaryFolder folder;
  NetworkMap map = makeExample();
  {
    Hdf5Writer file(folder.getPath() / "map.h5");
    writeNetworkGroup(file, "/online/network", map);
    file.close();
  }
  NetworkMap read = readNetworkGroup(Hdf5Reader(folder.getPath() / "map.h5"), "/online/network");
  map.validation.stddev_scale = read.validation.stddev_scale = VectorXd::Ones(2);
  const MatrixXd features = MatrixXd::Random(5, 9), known = MatrixXd::Random(1, 9);
  const Predictions expected = map.predict(features, known), found = read.predict(features, known);
  EXPECT_EQ(found.mean, expected.mean);
  EXPECT_EQ(found.stddev, expected.stddev);
}

}  // namespace
}  // namespace twinmap
