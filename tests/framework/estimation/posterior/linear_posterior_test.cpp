// Posteriors of more parameters than mixtures can follow.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "framework/estimation/posterior/simulator_posterior.hpp"
#include "tests/framework/estimation/refined/problem.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using testing::makeMatrix;
using testing::Problem;

constexpr int kUnknown = 30, kSeen = 10, kTimes = 40;
constexpr double kNoise = 0.05;

SimulatorPosterior sample(Problem& problem, const VectorXd& features, int draws = 4000) {
  SimulatorPosteriorOptions options;
  options.draws = draws;
  return samplePosterior(problem.simulator, problem.model, {}, features, VectorXd::Zero(kUnknown),
                         MatrixXd(kUnknown, 0), options);
}

/// The response sees ten of thirty parameters, and these linearly.
VectorXd respond(const VectorXd& x) {
  return makeMatrix(kTimes, kSeen) * x.head(kSeen);
}

TEST(ManyParameters, AreLeastSquaresWhereSeenAndUniformWhereNot) {
  Problem problem(kTimes, respond, testing::makeParameters(kUnknown, -1.0, 1.0), kNoise);
  const VectorXd truth = VectorXd::LinSpaced(kUnknown, -0.3, 0.3);
  const VectorXd features = problem.measure(truth, kNoise);
  const SimulatorPosterior posterior = sample(problem, features);
  ASSERT_TRUE(posterior.isReliable()) << posterior.message;
  const MatrixXd matrix = makeMatrix(kTimes, kSeen);
  const MatrixXd covariance = kNoise * kNoise * MatrixXd((matrix.transpose() * matrix).inverse());
  const VectorXd mean = covariance * matrix.transpose() * features / (kNoise * kNoise);
  for (Index j = 0; j < kUnknown; ++j) {
    const double stddev = j < kSeen ? std::sqrt(covariance(j, j)) : 1.0 / std::sqrt(3.0);
    EXPECT_NEAR(posterior.mean[j], j < kSeen ? mean[j] : 0.0, 0.08 * stddev);
    EXPECT_NEAR(posterior.stddev[j] / stddev, 1.0, 0.06);
  }
  EXPECT_GT(posterior.effective_sample_size, 3900.0);  // the response is linear: all weights are the same
  EXPECT_LT(posterior.simulations, 4000 + 1500);
}

TEST(ManyParameters, KeepPriorsOfAnyShape) {
  std::vector<ParameterSpec> unknown = testing::makeParameters(kUnknown, 0.5, 2.0);
  unknown[20].prior = PriorSpec{NormalPrior{1.0, 0.1}};
  Problem problem(kTimes, respond, unknown, kNoise);
  const VectorXd features = problem.measure(VectorXd::Constant(kUnknown, 1.1), kNoise);
  const SimulatorPosterior posterior = sample(problem, features);
  ASSERT_TRUE(posterior.isReliable()) << posterior.message;
  EXPECT_NEAR(posterior.mean[20], 1.0, 0.008);
  EXPECT_NEAR(posterior.stddev[20], 0.1, 0.006);
  EXPECT_NEAR(posterior.mean[25], 1.25, 0.04);  // uniform in the parameter, though searched in its logarithm
  EXPECT_NEAR(posterior.stddev[25], 1.5 / std::sqrt(12.0), 0.03);
}

/// Twenty parameters bend the response by far more than its noise where the prior still allows them.
TEST(ManyParameters, AreUnreliableWhereTheResponseIsFarFromLinear) {
  const auto bent = [](const VectorXd& x) {
    VectorXd response = respond(x);
    response.head(kSeen) += 3.0 * x.segment(kSeen, kSeen).cwiseAbs2() - 3.0 * x.tail(kSeen).cwiseAbs2();
    return response;
  };
  Problem problem(kTimes, bent, testing::makeParameters(kUnknown, -1.0, 1.0), kNoise);
  const SimulatorPosterior posterior =
      sample(problem, problem.measure(VectorXd::Constant(kUnknown, 0.4), kNoise), 500);
  EXPECT_FALSE(posterior.isReliable());
}

}  // namespace
}  // namespace twinmap
