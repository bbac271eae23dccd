#include "framework/estimation/gp/online_processes.hpp"

#include <gtest/gtest.h>

#include "tests/framework/estimation/trained/oscillation.hpp"

namespace twinmap {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using testing::Oscillation;

void expectSame(const OnlineProcesses& online, const MatrixXd& features) {
  const Estimates expected = online.getMap().predict(features);
  OnlineProcesses::Workspace workspace(online);
  for (Eigen::Index i = 0; i < features.cols(); ++i) {
    const Estimate& inferred = online.infer(features.col(i), VectorXd(0), workspace);
    EXPECT_TRUE(inferred.mean.isApprox(expected.mean.col(i), 1e-9));
    EXPECT_TRUE(inferred.stddev.isApprox(expected.stddev.col(i), 1e-6));
  }
}

TEST(OnlineProcesses, InfersWhatItsMapPredicts) {
  const MatrixXd features =
      Oscillation::addNoise(Oscillation::calcClean(Oscillation::samplePoints(20, 5)), 5);
  const GpMap exact = Oscillation().trainMap();
  expectSame(OnlineProcesses(exact), features);               // exact processes
  expectSame(OnlineProcesses(compressMap(exact)), features);  // packed ones
}

TEST(OnlineProcesses, ACompressedMapPredictsAsTheExactOne) {
  const MatrixXd features =
      Oscillation::addNoise(Oscillation::calcClean(Oscillation::samplePoints(200, 5)), 5);
  const GpMap exact = Oscillation().trainMap(400);
  const GpMap compact = compressMap(exact);
  for (const gp::Process& process : compact.processes) {
    ASSERT_TRUE(std::holds_alternative<std::shared_ptr<const gp::SparseGaussianProcess>>(process));
  }
  const Estimates expected = exact.predict(features), actual = compact.predict(features);
  EXPECT_LT((actual.mean - expected.mean).cwiseQuotient(expected.stddev).cwiseAbs().maxCoeff(), 0.02);
  EXPECT_LT((actual.stddev.cwiseQuotient(expected.stddev).array() - 1.0).abs().maxCoeff(), 0.005);
}

TEST(Estimator, PredictsEachColumnAsItInfersIt) {
  const MatrixXd features =
      Oscillation::addNoise(Oscillation::calcClean(Oscillation::samplePoints(150, 5)), 5);
  const OnlineProcesses map(Oscillation().trainMap());
  const Estimates alone = map.predict(features, MatrixXd(), 1),
                  together = map.predict(features, MatrixXd(), 3);
  EXPECT_EQ(alone.mean, together.mean);
  EXPECT_EQ(alone.stddev, together.stddev);
  OnlineProcesses::Workspace workspace(map);
  for (Eigen::Index i = 0; i < features.cols(); ++i) {
    const Estimate& inferred = map.infer(features.col(i), VectorXd(0), workspace);
    EXPECT_EQ(alone.mean.col(i), inferred.mean);
    EXPECT_EQ(alone.stddev.col(i), inferred.stddev);
  }
}

TEST(Estimator, RefusesToPredictFromOtherSizes) {
  const OnlineProcesses map(Oscillation().trainMap());
  EXPECT_EQ(map.predict(MatrixXd(Oscillation::kSamples, 0), MatrixXd(), 1).mean.cols(), 0);
  EXPECT_THROW(map.predict(MatrixXd::Zero(Oscillation::kSamples - 1, 2), MatrixXd(), 1),
               std::invalid_argument);
  EXPECT_THROW(map.predict(MatrixXd::Zero(Oscillation::kSamples, 2), MatrixXd::Zero(1, 2), 1),
               std::invalid_argument);
}

}  // namespace
}  // namespace twinmap
