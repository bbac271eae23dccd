#include "kernels/gp/sparse/compression.hpp"

#include <gtest/gtest.h>

#include "kernels/gp/fit.hpp"
#include "kernels/gp/online/online_predictor.hpp"
#include "tests/kernels/support/random_data.hpp"

namespace twinmap::gp {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using test::randomMatrix;

std::shared_ptr<const GaussianProcess> fitSmooth(const ModelStructure& structure, int samples = 600) {
  const MatrixXd inputs = randomMatrix(3, samples, 1);
  const int groups = getGroupCount(structure);
  const Hyperparameters hyperparameters{VectorXd::LinSpaced(groups, 2.0, 3.0), 1.4, 0.1, 1.0, 1.0};
  return fit(inputs, test::smoothTarget(inputs, 0.2, 2), structure, hyperparameters);
}

class Compression : public testing::TestWithParam<ModelStructure> {};

TEST_P(Compression, KeepsThePredictionsOfTheExactProcessWithFewerInputs) {
  const auto exact = fitSmooth(GetParam());
  const auto compact = compress(*exact, 1e-5);
  ASSERT_TRUE(compact);
  EXPECT_LT(compact->getInducingCount(), 300);
  const MatrixXd tests = randomMatrix(3, 200, 3);
  const Prediction expected = exact->predict(tests), actual = compact->predict(tests);
  const VectorXd error = (actual.mean - expected.mean).cwiseQuotient(expected.stddev());
  EXPECT_LT(error.cwiseAbs().maxCoeff(), 0.01);
  EXPECT_LT((actual.stddev().cwiseQuotient(expected.stddev()).array() - 1.0).abs().maxCoeff(), 2e-3);
}

TEST_P(Compression, OnlineItPredictsTheSame) {
  const auto compact = compress(*fitSmooth(GetParam()), 1e-3);
  ASSERT_TRUE(compact);
  const OnlinePredictor predictor({compact, compact});
  OnlinePredictor::Workspace workspace(predictor);
  const MatrixXd tests = randomMatrix(3, 50, 4);
  const Prediction expected = compact->predict(tests);
  const MatrixXd gradient = compact->getMean().predictMeanGradient(tests);
  for (Eigen::Index i = 0; i < tests.cols(); ++i) {
    predictor.predictWithGradient(tests.col(i), workspace);
    EXPECT_NEAR(workspace.values.mean(1), expected.mean(i), 1e-9);
    EXPECT_NEAR(workspace.values.latent_variance(1), expected.latent_variance(i), 1e-9);
    EXPECT_LT((workspace.values.gradient.col(1) - gradient.col(i)).norm(), 1e-8);
  }
}

TEST_P(Compression, TheGradientOfTheMeanEqualsFiniteDifferences) {
  const auto exact = fitSmooth(GetParam(), 80);
  const MatrixXd tests = randomMatrix(3, 20, 5);
  const MatrixXd gradient = exact->getMean().predictMeanGradient(tests);
  constexpr double kStep = 1e-5;
  for (int d = 0; d < 3; ++d) {
    MatrixXd above = tests, below = tests;
    above.row(d).array() += kStep;
    below.row(d).array() -= kStep;
    const VectorXd expected =
        (exact->getMean().predictMean(above) - exact->getMean().predictMean(below)) / (2.0 * kStep);
    EXPECT_LT((gradient.row(d).transpose() - expected).cwiseAbs().maxCoeff(), 1e-6);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Structures, Compression,
    testing::Values(
        ModelStructure{CovarianceFunction::kSquaredExponential, {}, false, MeanFunction::kConstant},
        ModelStructure{CovarianceFunction::kSquaredExponential, {0, 1, 2}, false, MeanFunction::kLinear},
        ModelStructure{CovarianceFunction::kRationalQuadratic, {0, 1, 1}, false, MeanFunction::kZero}));

TEST(CompressionLimits, AProcessWithALinearTermOrRoughOnesAreLeftAsTheyAre) {
  EXPECT_FALSE(compress(*fitSmooth({CovarianceFunction::kSquaredExponential, {}, true}), 1e-3));
  EXPECT_FALSE(compress(*fitSmooth({CovarianceFunction::kMatern32, {}}, 40), 1e-6));
}

TEST(CompressionLimits, AProcessThatIsNearlyAllNoiseIsStillOne) {
  const MatrixXd inputs = randomMatrix(3, 50, 1), tests = randomMatrix(3, 20, 2);
  const Hyperparameters hyperparameters{VectorXd::Constant(1, 3.0), 0.01, 2.0, 1.0, 1.0};
  const auto exact = fit(inputs, randomMatrix(1, 50, 3).transpose(), {}, hyperparameters);
  const auto compact = compress(*exact, 1e-3);
  ASSERT_TRUE(compact);
  EXPECT_LT((compact->predict(tests).mean - exact->predict(tests).mean).cwiseAbs().maxCoeff(), 0.01);
}

TEST(LinearTerm, TheGradientOfTheMeanEqualsFiniteDifferences) {
  const auto exact = fitSmooth({CovarianceFunction::kMatern52, {0, 1, 0}, true, MeanFunction::kLinear}, 60);
  const VectorXd at = randomMatrix(3, 1, 6);
  const MatrixXd gradient = exact->getMean().predictMeanGradient(at);
  for (int d = 0; d < 3; ++d) {
    const VectorXd step = 1e-5 * VectorXd::Unit(3, d);
    const double expected =
        (exact->getMean().predictMean(at + step)(0) - exact->getMean().predictMean(at - step)(0)) / 2e-5;
    EXPECT_NEAR(gradient(d, 0), expected, 1e-6);
  }
}

}  // namespace
}  // namespace twinmap::gp
