#include "framework/online/trust_model.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/framework/online/oscillation.hpp"

namespace twinmap {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using testing::Oscillation;

class TrustTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    map_ = new OnlineMap(compressMap(Oscillation().trainMap()));
    model_ = new TrustModel(fitTrustModel(Oscillation().makeTrustTraining(), *map_, 0.01));
  }
  static void TearDownTestSuite() {
    delete model_;
    delete map_;
  }

  static Trust judgeFeatures(const VectorXd& features) {
    OnlineMap::Workspace inferring(*map_);
    TrustWorkspace judging;
    return judge(*model_, features, VectorXd(0), map_->infer(features, VectorXd(0), inferring), judging);
  }

  /// The share of measurements with this status, each first changed by `disturb`.
  template <class Disturb>
  static double calcShare(TrustStatus status, int n, const Disturb& disturb) {
    MatrixXd measured = Oscillation::addNoise(Oscillation::calcClean(Oscillation::samplePoints(n, 11)), 12);
    int count = 0;
    for (int i = 0; i < n; ++i) {
      VectorXd features = measured.col(i);
      disturb(features);
      const std::vector<TrustStatus> statuses = judgeFeatures(features).statuses;
      count += std::count(statuses.begin(), statuses.end(), status) > 0 ? 1 : 0;
    }
    return static_cast<double>(count) / n;
  }

  static OnlineMap* map_;
  static TrustModel* model_;
};

OnlineMap* TrustTest::map_ = nullptr;
TrustModel* TrustTest::model_ = nullptr;

TEST_F(TrustTest, FalseAlarmsAreAtTheLevel) {
  // 2000 measurements at 1 %: three standard errors are 0.7 %, and 0.7 % more of the 1500 references.
  EXPECT_NEAR(calcShare(TrustStatus::kModelMismatch, 2000, [](VectorXd&) {}), 0.01, 0.01);
  EXPECT_LT(calcShare(TrustStatus::kOutsideTraining, 500, [](VectorXd&) {}), 0.01);
  EXPECT_LT(calcShare(TrustStatus::kAtBounds, 500, [](VectorXd&) {}), 0.02);
  EXPECT_EQ(calcShare(TrustStatus::kUninformative, 500, [](VectorXd&) {}), 0.0);
}

TEST_F(TrustTest, FindsWhatTheModelCannotExplain) {
  const double noise = Oscillation::kNoise;
  const auto mismatch = TrustStatus::kModelMismatch;
  EXPECT_EQ(calcShare(mismatch, 200, [&](VectorXd& f) { f[30] += 10.0 * noise; }), 1.0);
  EXPECT_EQ(calcShare(mismatch, 200, [&](VectorXd& f) { f += VectorXd::LinSpaced(60, 0, 10 * noise); }), 1.0);
  EXPECT_GT(calcShare(mismatch, 200, [&](VectorXd& f) { f.tail(20).setConstant(f[39]); }), 0.95);
  EXPECT_EQ(calcShare(mismatch, 200, [&](VectorXd& f) { f *= 1.1; }), 1.0);
  EXPECT_GT(calcShare(mismatch, 200, [&](VectorXd& f) { f.head(59) = f.tail(59).eval(); }), 0.95);
}

TEST_F(TrustTest, FindsParametersBeyondTheirBounds) {
  const Trust trust = judgeFeatures(Oscillation::calcClean(0.2, 3.05));
  EXPECT_TRUE(std::count(trust.statuses.begin(), trust.statuses.end(), TrustStatus::kAtBounds) > 0 ||
              std::count(trust.statuses.begin(), trust.statuses.end(), TrustStatus::kModelMismatch) > 0);
  const Trust far = judgeFeatures(Oscillation::calcClean(0.2, 4.5));
  EXPECT_GT(far.distance, 1.5);
  EXPECT_TRUE(std::count(far.statuses.begin(), far.statuses.end(), TrustStatus::kOutsideTraining) > 0);
}

TEST_F(TrustTest, SaysWhereItIsUninformed) {
  Inference inference;
  inference.mean = (VectorXd(2) << 0.2, 2.5).finished();
  inference.stddev = (VectorXd(2) << 0.056, 0.01).finished();  // the box has 0.0577 and 0.29
  OnlineMap::Workspace workspace(*map_);
  const VectorXd features = Oscillation::calcClean(0.2, 2.5);
  inference.inputs = map_->infer(features, VectorXd(0), workspace).inputs;
  TrustWorkspace judging;
  const Trust trust = judge(*model_, features, VectorXd(0), inference, judging);
  EXPECT_EQ(trust.statuses, std::vector<TrustStatus>{TrustStatus::kUninformative});
}

TEST(ReferenceDistribution, GivesTheShareAtLeastAsLarge) {
  const ReferenceDistribution reference{(VectorXd(4) << 1.0, 2.0, 3.0, 4.0).finished()};
  EXPECT_DOUBLE_EQ(reference.calcPValue(0.0), 1.0);
  EXPECT_DOUBLE_EQ(reference.calcPValue(3.0), 0.6);
  EXPECT_DOUBLE_EQ(reference.calcPValue(9.0), 0.2);
}

}  // namespace
}  // namespace twinmap
