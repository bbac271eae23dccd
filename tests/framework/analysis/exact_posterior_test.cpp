#include "framework/analysis/exact_posterior.hpp"

#include <gtest/gtest.h>

#include <boost/math/distributions/normal.hpp>
#include <cmath>

#include "tests/framework/support/linear_simulator.hpp"
#include "tests/lu.hpp"

namespace twinmap::testing {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

std::vector<ExactPosterior> calcPosteriors(const LinearSimulator& simulator,
                                           const std::vector<ParameterSpec>& parameters,
                                           const MatrixXd& covariance, const MatrixXd& measured,
                                           int threads = 1, const MatrixXd& inputs = {}) {
  const FeatureExtractor extractor(makeAllFeatures(simulator), simulator.getLayout());
  const MatrixXd starts =
      MatrixXd::Constant(static_cast<Eigen::Index>(parameters.size()), measured.cols(), 0.5);
  return calcExactPosteriors(simulator, extractor, NoiseWhitener(covariance), parameters,
                             {measured, starts, inputs}, {1000, 7, threads});
}

// With a wide box the posterior is normal, with the moments of the normal equations.
TEST(ExactPosterior, OfALinearModelIsTheNormalOne) {
  MatrixXd matrix(3, 2);
  matrix << 1, 2, 0.5, -1, 1, 1.5;
  MatrixXd covariance(3, 3);
  covariance << 0.04, 0.01, 0, 0.01, 0.09, 0, 0, 0, 0.01;
  VectorXd measured(3);
  measured << 2.0, -0.85, 1.55;
  const MatrixXd precision = test::calcInverse(covariance);
  const MatrixXd expected = test::calcInverse(matrix.transpose() * precision * matrix);
  const VectorXd mean = expected * matrix.transpose() * precision * measured;
  const auto posterior =
      calcPosteriors(LinearSimulator(matrix), makeParameters(2, -20.0, 20.0), covariance, measured)[0];
  ASSERT_EQ(posterior.warning, "");
  EXPECT_GT(posterior.effective_sample_size, 700.0);
  for (int j = 0; j < 2; ++j) {
    EXPECT_NEAR(posterior.mean[j], mean[j], 0.02 * std::sqrt(expected(j, j)));
    EXPECT_NEAR(posterior.stddev[j] / std::sqrt(expected(j, j)), 1.0, 0.02);
  }
}

// One parameter, measured as 0.9 with stddev 0.2 and known to lie in [0, 1]: a truncated normal distribution.
TEST(ExactPosterior, OfABoundedParameterIsTruncated) {
  constexpr double kMeasured = 0.9, kStddev = 0.2;
  const boost::math::normal standard;
  const double alpha = (0.0 - kMeasured) / kStddev, beta = (1.0 - kMeasured) / kStddev;
  const double mass = cdf(standard, beta) - cdf(standard, alpha);
  const double shift = (pdf(standard, alpha) - pdf(standard, beta)) / mass;
  const double mean = kMeasured + kStddev * shift;
  const double variance =
      kStddev * kStddev *
      (1.0 + (alpha * pdf(standard, alpha) - beta * pdf(standard, beta)) / mass - shift * shift);
  const auto posterior =
      calcPosteriors(LinearSimulator(MatrixXd::Ones(1, 1)), makeParameters(1, 0.0, 1.0),
                     MatrixXd::Constant(1, 1, kStddev * kStddev), MatrixXd::Constant(1, 1, kMeasured))[0];
  ASSERT_EQ(posterior.warning, "");
  EXPECT_NEAR(posterior.mean[0], mean, 0.02 * kStddev);
  EXPECT_NEAR(posterior.stddev[0] / std::sqrt(variance), 1.0, 0.03);
}

// y = a + u with u known: the posterior of a is that of y - u.
TEST(ExactPosterior, HoldsKnownInputs) {
  const auto posterior = calcPosteriors(LinearSimulator(MatrixXd::Ones(1, 2)), makeParameters(1, -20.0, 20.0),
                                        MatrixXd::Constant(1, 1, 0.04), MatrixXd::Constant(1, 1, 5.0), 1,
                                        MatrixXd::Constant(1, 1, 3.5))[0];
  ASSERT_EQ(posterior.warning, "");
  EXPECT_NEAR(posterior.mean[0], 1.5, 0.004);
  EXPECT_NEAR(posterior.stddev[0], 0.2, 0.004);
}

TEST(ExactPosterior, IsTheSameForAnyNumberOfThreads) {
  const LinearSimulator simulator(MatrixXd::Ones(2, 1));
  const MatrixXd measured = MatrixXd::Random(2, 5);
  const MatrixXd covariance = MatrixXd::Identity(2, 2);
  const auto expected = calcPosteriors(simulator, makeParameters(1, -9.0, 9.0), covariance, measured, 1);
  const auto found = calcPosteriors(simulator, makeParameters(1, -9.0, 9.0), covariance, measured, 3);
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(found[i].mean, expected[i].mean);
    EXPECT_EQ(found[i].stddev, expected[i].stddev);
  }
}

TEST(ExactPosterior, SaysWhyThereIsNone) {
  const LinearSimulator simulator(MatrixXd::Ones(2, 1), -10.0);  // fails everywhere
  const auto posterior = calcPosteriors(simulator, makeParameters(1, 0.0, 1.0), MatrixXd::Identity(2, 2),
                                        MatrixXd::Zero(2, 1))[0];
  EXPECT_NE(posterior.warning.find("too much"), std::string::npos);
  EXPECT_TRUE(std::isnan(posterior.mean[0]));
}

}  // namespace
}  // namespace twinmap::testing
