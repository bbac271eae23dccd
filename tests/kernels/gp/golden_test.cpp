// NLML, gradient and predictions against scikit-learn 1.2.1 (see ../golden/make_sklearn_golden.py).
#include <gtest/gtest.h>

#include "kernels/gp/fit.hpp"
#include "kernels/gp/online_predictor.hpp"
#include "tests/kernels/golden/sklearn_golden.hpp"

namespace twinmap::gp {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kRelative = 1e-8;

VectorXd vector_of(const std::vector<double>& values) {
  return Eigen::Map<const VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

// scikit-learn's rows are samples: in memory the same as our columns.
MatrixXd samples_of(const std::vector<double>& values) {
  const auto count = static_cast<Eigen::Index>(values.size());
  return Eigen::Map<const MatrixXd>(values.data(), golden::kFeatures, count / golden::kFeatures);
}

void expect_close(const VectorXd& actual, const std::vector<double>& expected, const char* what) {
  ASSERT_EQ(actual.size(), static_cast<Eigen::Index>(expected.size())) << what;
  for (Eigen::Index i = 0; i < actual.size(); ++i) {
    EXPECT_NEAR(actual(i), expected[i], kRelative * std::max(1.0, std::abs(expected[i]))) << what << " " << i;
  }
}

class Golden : public testing::TestWithParam<golden::Case> {
 protected:
  ModelStructure structure() const {
    return {GetParam().covariance, GetParam().groups, GetParam().linear_term, GetParam().mean};
  }
  Hyperparameters hyperparameters() const {
    return {vector_of(GetParam().length_scales), golden::kSignalStddev, golden::kNoiseStddev, golden::kShape,
            golden::kLinearStddev};
  }
  MatrixXd inputs_ = samples_of(golden::kInputs);
  MatrixXd tests_ = samples_of(golden::kTestInputs);
  VectorXd target_ = vector_of(golden::kTarget);
};

TEST_P(Golden, marginal_likelihood_and_gradient) {
  const TrainingSet set(inputs_, structure());
  LikelihoodWorkspace workspace(set);
  VectorXd gradient(HyperparameterLayout(structure()).count);
  const LikelihoodEvaluation evaluation =
      evaluate_likelihood_gradient(set, target_, hyperparameters(), workspace, gradient);
  ASSERT_TRUE(evaluation.ok);
  EXPECT_EQ(evaluation.jitter, 0.0);
  EXPECT_NEAR(evaluation.nlml, GetParam().nlml, kRelative * std::abs(GetParam().nlml));
  expect_close(gradient, GetParam().gradient, "gradient");
}

TEST_P(Golden, predictions) {
  const auto gp = fit(inputs_, target_, structure(), hyperparameters());
  const Prediction prediction = gp->predict(tests_);
  expect_close(prediction.mean, GetParam().predicted_mean, "mean");
  expect_close(prediction.stddev(), GetParam().predicted_stddev, "stddev");
}

TEST_P(Golden, online_predictions) {
  const auto gp = fit(inputs_, target_, structure(), hyperparameters());
  const OnlinePredictor predictor({gp, gp});
  OnlinePredictor::Workspace workspace(predictor);
  VectorXd mean(2), stddev(2);
  for (int i = 0; i < golden::kTests; ++i) {
    predictor.predict(tests_.col(i), mean, stddev, workspace);
    for (int t = 0; t < 2; ++t) {
      EXPECT_NEAR(mean(t), GetParam().predicted_mean[i], kRelative);
      EXPECT_NEAR(stddev(t), GetParam().predicted_stddev[i], kRelative);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Sklearn, Golden, testing::ValuesIn(golden::kCases),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace twinmap::gp
