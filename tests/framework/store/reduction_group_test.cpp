#include "framework/store/reduction_group.hpp"

#include <gtest/gtest.h>

#include "framework/base/files/temporary_folder.hpp"
#include "framework/data/features/experiment_features.hpp"
#include "framework/experiment/files/experiment_file.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr const char* kCart = TWINMAP_SOURCE_DIR "/experiments/duffing/cart.yaml";

ExperimentSpec loadLong(int count) {
  return loadExperiment(kCart, {"features=[{samples: {outputs: [x], start: 0.005, interval: 0.005, count: " +
                                std::to_string(count) + ", reduce: automatic}}]"});
}

ResponseReduction makeReduction(const ExperimentSpec& experiment) {
  const ResponseLayout layout = makeLayout(experiment);
  ResponseReduction reduction;
  reduction.windows = partResponse(experiment, layout);
  reduction.center = VectorXd::Random(layout.getRowCount());
  reduction.inverse_stddev = VectorXd::Constant(layout.getRowCount(), 1e4);
  reduction.stddev_ratio = VectorXd::Constant(3, 1.001);
  for (ReductionWindow& window : reduction.windows) {
    const auto rows = static_cast<Index>(window.rows.size());
    window.directions = Eigen::MatrixXf::Identity(rows, 2);
    setScales(0.5, window);
  }
  reduction.layout = makeReducedLayout(static_cast<Index>(reduction.windows.size()), 2, 5.0);
  return reduction;
}

class ReductionGroup : public ::testing::Test {
 protected:
  ResponseReduction readBack() const {
    {
      Hdf5Writer file(folder_.getPath() / "reduction.h5");
      writeReduction(file, "/reduction", reduction_);
      file.close();
    }
    return readReduction(Hdf5Reader(folder_.getPath() / "reduction.h5"), "/reduction");
  }

  const TemporaryFolder folder_;
  const ExperimentSpec experiment_ = loadLong(1000);
  const ResponseReduction reduction_ = makeReduction(experiment_);
};

TEST_F(ReductionGroup, ReducesAsBeforeWhenItIsReadBack) {
  ResponseReduction again = readBack();
  placeRows(experiment_, makeLayout(experiment_), again);
  EXPECT_EQ(again.calcDigest(), reduction_.calcDigest());
  const VectorXd response = VectorXd::Random(reduction_.center.size());
  EXPECT_EQ(again.reduceMeasured(response), reduction_.reduceMeasured(response));
  EXPECT_EQ(again.layout.output_names, reduction_.layout.output_names);
}

TEST_F(ReductionGroup, IsRefusedByAnExperimentOfOtherSamples) {
  ResponseReduction again = readBack();
  const ExperimentSpec other = loadLong(900);
  EXPECT_THROW(placeRows(other, makeLayout(other), again), std::runtime_error);
}

}  // namespace
}  // namespace twinmap
