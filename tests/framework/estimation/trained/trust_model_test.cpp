#include "framework/estimation/trained/trust_model.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "framework/base/random/random.hpp"
#include "tests/framework/estimation/trained/oscillation.hpp"

namespace twinmap {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using testing::Oscillation;

class TrustTest : public ::testing::Test {
 protected:
  static std::shared_ptr<const ForwardSurrogate> shareSurrogate(const TrustTraining& training) {
    return std::make_shared<const ForwardSurrogate>(Oscillation::fitSurrogate(training));
  }

  static void SetUpTestSuite() {
    map_ = new OnlineProcesses(compressMap(Oscillation().trainMap()));
    const TrustTraining training = Oscillation().makeTrustTraining();
    model_ = new TrustModel(fitTrustModel(training, shareSurrogate(training), *map_, 0.01, {2}));
  }
  static void TearDownTestSuite() {
    delete model_;
    delete map_;
  }

  static Trust judgeFeatures(const VectorXd& features) {
    OnlineProcesses::Workspace inferring(*map_);
    TrustWorkspace judging(*model_);
    return judge(*model_, features, VectorXd(0), map_->infer(features, VectorXd(0), inferring), nullptr,
                 judging);
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

  static OnlineProcesses* map_;
  static TrustModel* model_;
};

OnlineProcesses* TrustTest::map_ = nullptr;
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
  Estimate inference;
  inference.mean = (VectorXd(2) << 0.2, 2.5).finished();
  inference.stddev = (VectorXd(2) << 0.056, 0.01).finished();  // the box has 0.0577 and 0.29
  OnlineProcesses::Workspace workspace(*map_);
  const VectorXd features = Oscillation::calcClean(0.2, 2.5);
  inference.inputs = map_->infer(features, VectorXd(0), workspace).inputs;
  TrustWorkspace judging(*model_);
  const Trust trust = judge(*model_, features, VectorXd(0), inference, nullptr, judging);
  EXPECT_EQ(trust.statuses, std::vector<TrustStatus>{TrustStatus::kUninformative});
}

TEST_F(TrustTest, TakesOverTheExplanationThatASurrogatesOwnSearchFound) {
  const ForwardSurrogate& surrogate = *model_->forward;
  const MatrixXd scores = surrogate.calcScores(
      Oscillation::addNoise(Oscillation::calcClean(Oscillation::samplePoints(20, 21)), 22));
  ScoreInversion inferring(surrogate, makeUniformPrior(2)), searching(surrogate, makeUniformPrior(2));
  for (Eigen::Index i = 0; i < scores.cols(); ++i) {
    inferring.infer(scores.col(i), VectorXd(0));
    ASSERT_NE(inferring.findExplanation(), nullptr);
    const double from_center =
        searching.explain(scores.col(i), VectorXd(0), VectorXd::Zero(2)).innovation.squaredNorm();
    EXPECT_NEAR(inferring.findExplanation()->innovation.squaredNorm(), from_center, 0.05);  // a search's end
  }
}

TEST_F(TrustTest, DoesNotDependOnTheThreads) {
  TrustTraining training = Oscillation().makeTrustTraining();
  training.measured = training.measured.leftCols(40).eval();
  training.known.resize(0, 40);
  const auto surrogate = shareSurrogate(training);
  const TrustModel alone = fitTrustModel(training, surrogate, *map_, 0.01, {1});
  const TrustModel together = fitTrustModel(training, surrogate, *map_, 0.01, {3});
  EXPECT_EQ(alone.chi_square.sorted, together.chi_square.sorted);
  EXPECT_EQ(alone.anomaly.sorted, together.anomaly.sorted);
  EXPECT_EQ(alone.cloud.reach, together.cloud.reach);
}

/// What the simulator leaves of a measurement whose residual is `scale` times white noise.
SimulatorResidual makeResidual(std::uint64_t sample, double scale, bool explained) {
  const RandomStream random(5, RandomPurpose::kTestNoise);
  SimulatorResidual found;
  found.residual = VectorXd::NullaryExpr(Oscillation::kSamples, [&](Eigen::Index i) {
    return scale * random.calcNormal(sample, static_cast<std::uint64_t>(i));
  });
  found.degrees = static_cast<double>(Oscillation::kSamples);
  found.reduced_chi_square = found.residual.squaredNorm() / found.degrees;
  found.explained = explained;
  return found;
}

bool isMismatch(const Trust& trust) {
  return std::count(trust.statuses.begin(), trust.statuses.end(), TrustStatus::kModelMismatch) > 0;
}

TEST_F(TrustTest, JudgesWhatTheSimulatorExplainsAgainstNoiseAtTheLevel) {
  TrustModel model = *model_;
  model.refinement.tried = 2000;
  const Trust by_surrogate = judgeFeatures(Oscillation::calcClean(0.2, 2.5));
  int found = 0;
  for (std::uint64_t i = 0; i < 3000; ++i) {
    found += isMismatch(judgeAnew(model, by_surrogate, makeResidual(i, 1.0, true))) ? 1 : 0;
  }
  EXPECT_NEAR(found / 3000.0, 0.01, 0.007);  // three standard errors and that of 4000 references
  EXPECT_TRUE(isMismatch(judgeAnew(model, by_surrogate, makeResidual(1, 1.6, true))));
}

TEST_F(TrustTest, SuspectsWhatTheSimulatorDoesNotExplainAsFarAsThatIsRare) {
  TrustModel model = *model_;
  const Trust by_surrogate = judgeFeatures(Oscillation::calcClean(0.2, 2.5));
  ASSERT_FALSE(isMismatch(by_surrogate));
  const auto judge_scaled = [&](double scale) {
    return isMismatch(judgeAnew(model, by_surrogate, makeResidual(1, scale, false)));
  };
  EXPECT_TRUE(judge_scaled(3.0));  // nothing was ever refined: chi-square decides
  EXPECT_FALSE(judge_scaled(1.0));
  model.refinement.tried = 400;
  EXPECT_TRUE(judge_scaled(3.0));                                      // never seen
  model.refinement.unexplained = VectorXd::LinSpaced(12, 4.0, 400.0);  // 3 %: half of the level is 2 of 400
  EXPECT_FALSE(judge_scaled(3.0));
  EXPECT_FALSE(judge_scaled(15.0));
  EXPECT_TRUE(judge_scaled(30.0));
}

TEST(ReferenceDistribution, GivesTheShareAtLeastAsLarge) {
  const ReferenceDistribution reference{(VectorXd(4) << 1.0, 2.0, 3.0, 4.0).finished()};
  EXPECT_DOUBLE_EQ(reference.calcPValue(0.0), 1.0);
  EXPECT_DOUBLE_EQ(reference.calcPValue(3.0), 0.6);
  EXPECT_DOUBLE_EQ(reference.calcPValue(9.0), 0.2);
}

}  // namespace
}  // namespace twinmap
