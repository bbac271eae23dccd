// NLML, gradient and predictions against scikit-learn 1.2.1 (see ../golden/make_sklearn_golden.py).
#include <gtest/gtest.h>

#include "kernels/gp/fit.hpp"
#include "kernels/gp/online/online_predictor.hpp"
#include "tests/kernels/golden/sklearn_golden.hpp"

namespace twinmap::gp {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kRelative = 1e-8;

VectorXd vectorOf(const std::vector<double>& values) {
  return Eigen::Map<const VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

// scikit-learn's rows are samples: in memory the same as our columns.
MatrixXd samplesOf(const std::vector<double>& values) {
  const auto count = static_cast<Eigen::Index>(values.size());
  return Eigen::Map<const MatrixXd>(values.data(), golden::kFeatures, count / golden::kFeatures);
}

void expectClose(const VectorXd& actual, const std::vector<double>& expected, const char* what) {
  ASSERT_EQ(actual.size(), static_cast<Eigen::Index>(expected.size())) << what;
  for (Eigen::Index i = 0; i < actual.size(); ++i) {
    EXPECT_NEAR(actual(i), expected[i], kRelative * std::max(1.0, std::abs(expected[i]))) << what << " " << i;
  }
}

class Golden : public testing::TestWithParam<golden::Case> {
 protected:
  ModelStructure getStructure() const {
    return {GetParam().covariance, GetParam().groups, GetParam().linear_term, GetParam().mean};
  }
  Hyperparameters getHyperparameters() const {
    return {vectorOf(GetParam().length_scales), golden::kSignalStddev, golden::kNoiseStddev, golden::kShape,
            golden::kLinearStddev};
  }
  MatrixXd inputs_ = samplesOf(golden::kInputs);
  MatrixXd tests_ = samplesOf(golden::kTestInputs);
  VectorXd target_ = vectorOf(golden::kTarget);
};

TEST_P(Golden, MarginalLikelihoodAndGradient) {
  const TrainingSet set(inputs_, getStructure());
  LikelihoodWorkspace workspace(set);
  VectorXd gradient(HyperparameterLayout(getStructure()).count);
  const LikelihoodEvaluation evaluation =
      evaluateLikelihoodGradient(set, target_, getHyperparameters(), workspace, gradient);
  ASSERT_TRUE(evaluation.ok);
  EXPECT_EQ(evaluation.jitter, 0.0);
  EXPECT_NEAR(evaluation.nlml, GetParam().nlml, kRelative * std::abs(GetParam().nlml));
  expectClose(gradient, GetParam().gradient, "gradient");
}

TEST_P(Golden, Predictions) {
  const auto gp = fit(inputs_, target_, getStructure(), getHyperparameters());
  const Prediction prediction = gp->predict(tests_);
  expectClose(prediction.mean, GetParam().predicted_mean, "mean");
  expectClose(prediction.stddev(), GetParam().predicted_stddev, "stddev");
}

TEST_P(Golden, OnlinePredictions) {
  const auto gp = fit(inputs_, target_, getStructure(), getHyperparameters());
  const OnlinePredictor predictor({gp, gp});
  OnlinePredictor::Workspace workspace(predictor);
  for (int i = 0; i < golden::kTests; ++i) {
    predictor.predict(tests_.col(i), workspace);
    for (int t = 0; t < 2; ++t) {
      EXPECT_NEAR(workspace.values.mean(t), GetParam().predicted_mean[i], kRelative);
      EXPECT_NEAR(workspace.values.stddev(t), GetParam().predicted_stddev[i], kRelative);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Sklearn, Golden, testing::ValuesIn(golden::kCases),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace twinmap::gp
