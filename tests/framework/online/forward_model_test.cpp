#include "framework/online/forward_model.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "tests/framework/online/oscillation.hpp"

namespace twinmap {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using testing::Oscillation;

class ForwardModelTest : public ::testing::Test {
 protected:
  MatrixXd points_ = Oscillation::samplePoints(150, 1);
  MatrixXd normalized_ = normalize(points_);
  ForwardModel model_ =
      fitForwardModel(normalized_, Oscillation::calcClean(points_), Oscillation::getNoiseCovariance());
  ExplanationWorkspace workspace_;

  static MatrixXd normalize(const MatrixXd& points) {
    MatrixXd normalized = points;
    normalized.row(0) = (points.row(0).array() - 0.2) / 0.1;
    normalized.row(1) = (points.row(1).array() - 2.5) / 0.5;
    return normalized;
  }
};

TEST_F(ForwardModelTest, FindsThePointOfACleanResponseFromTheMiddleOfTheBox) {
  const MatrixXd points = Oscillation::samplePoints(30, 7);
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const VectorXd features = Oscillation::calcClean(points.col(i)).col(0);
    const Explanation& found = explain(model_, features, VectorXd::Zero(2), 2, workspace_);
    EXPECT_LT((found.point - normalize(points.col(i))).norm(), 0.01) << i;
    EXPECT_LT(found.chi_square, 1.0) << i;
  }
}

TEST_F(ForwardModelTest, LeavesTheNoiseOfTheOtherDimensions) {
  const int n = 300;
  const MatrixXd points = Oscillation::samplePoints(n, 8);
  const MatrixXd measured = Oscillation::addNoise(Oscillation::calcClean(points), 3);
  double mean = 0.0;
  for (int i = 0; i < n; ++i) {
    mean += explain(model_, measured.col(i), normalize(points.col(i)), 2, workspace_).chi_square / n;
  }
  // 60 features, 2 parameters fitted; the standard error of the mean is sqrt(2 * 58 / n) = 0.6.
  EXPECT_NEAR(mean, 58.0, 2.0);
}

TEST_F(ForwardModelTest, HoldsWhatIsKnown) {
  const VectorXd features = Oscillation::calcClean(0.15, 2.3);
  const VectorXd start = (VectorXd(2) << 0.0, 0.5).finished();
  const Explanation& found = explain(model_, features, start, 1, workspace_);
  EXPECT_EQ(found.point[1], 0.5);
  EXPECT_GT(found.chi_square, 1000.0);  // w = 2.75 does not explain w = 2.3
}

TEST_F(ForwardModelTest, DoesNotStretchToWhatTheBoxCannotExplain) {
  const VectorXd louder = 1.3 * Oscillation::calcClean(0.2, 2.5);  // in the span of the responses
  EXPECT_GT(explain(model_, louder, VectorXd::Zero(2), 2, workspace_).chi_square, 300.0);
}

TEST_F(ForwardModelTest, WhitensCorrelatedNoise) {
  MatrixXd covariance = Oscillation::getNoiseCovariance();
  for (int i = 0; i + 1 < Oscillation::kSamples; ++i) {
    covariance(i, i + 1) = covariance(i + 1, i) = 0.4 * covariance(i, i);
  }
  const ForwardModel model = fitForwardModel(normalized_, Oscillation::calcClean(points_), covariance);
  EXPECT_TRUE(
      (model.whitener * covariance * model.whitener.transpose()).isApprox(MatrixXd::Identity(60, 60), 1e-9));
  const VectorXd features = Oscillation::calcClean(0.25, 2.8);
  EXPECT_LT(explain(model, features, VectorXd::Zero(2), 2, workspace_).chi_square, 1.0);
}

TEST_F(ForwardModelTest, RefusesTooFewSimulationsAndFeaturesWithoutNoise) {
  const MatrixXd clean = Oscillation::calcClean(points_);
  EXPECT_THROW(
      (void)fitForwardModel(normalized_.leftCols(4), clean.leftCols(4), Oscillation::getNoiseCovariance()),
      std::invalid_argument);
  EXPECT_THROW((void)fitForwardModel(normalized_, clean, MatrixXd::Zero(60, 60)), std::invalid_argument);
}

}  // namespace
}  // namespace twinmap
