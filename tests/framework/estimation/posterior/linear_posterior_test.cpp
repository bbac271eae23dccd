// Posteriors of more parameters than mixtures can follow.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <string>

#include "framework/estimation/posterior/simulator_posterior.hpp"
#include "tests/framework/estimation/refined/problem.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using testing::Problem;

constexpr int kParameters = 30, kSeenParameters = 10, kSampleTimes = 40;
constexpr double kSampleNoise = 0.05;

SimulatorPosterior sampleMany(Problem& problem, const VectorXd& features, int draws = 4000,
                              bool is_linear = false) {
  SimulatorPosteriorOptions options;
  options.draws = draws;
  options.is_linear = is_linear;
  return samplePosterior(problem.simulator, problem.model, {}, features, VectorXd::Zero(kParameters),
                         MatrixXd(), options);
}

/// Entries without structure, so that its columns are well apart.
MatrixXd makeMixedMatrix() {
  return MatrixXd::NullaryExpr(kSampleTimes, kSeenParameters, [](Index i, Index j) {
    return std::sin(1.0 + static_cast<double>(i) * (0.9 + 1.7 * static_cast<double>(j)) +
                    1.3 * static_cast<double>(j * j));
  });
}

/// The response sees ten of thirty parameters, and these linearly.
VectorXd respondToSome(const VectorXd& x) {
  return makeMixedMatrix() * x.head(kSeenParameters);
}

void expectLeastSquaresWhereSeen(const SimulatorPosterior& posterior, const VectorXd& features) {
  ASSERT_TRUE(posterior.isReliable()) << posterior.message;
  const MatrixXd matrix = makeMixedMatrix();
  const MatrixXd covariance = kSampleNoise * kSampleNoise * MatrixXd((matrix.transpose() * matrix).inverse());
  const VectorXd mean = covariance * matrix.transpose() * features / (kSampleNoise * kSampleNoise);
  for (Index j = 0; j < kParameters; ++j) {
    const double stddev = j < kSeenParameters ? std::sqrt(covariance(j, j)) : 1.0 / std::sqrt(3.0);
    EXPECT_NEAR(posterior.mean[j], j < kSeenParameters ? mean[j] : 0.0, 0.1 * stddev);
    EXPECT_NEAR(posterior.stddev[j] / stddev, 1.0, 0.06);
  }
}

TEST(ManyParameters, AreLeastSquaresWhereSeenAndUniformWhereNot) {
  Problem problem(kSampleTimes, respondToSome, testing::makeParameters(kParameters, -1.0, 1.0), kSampleNoise);
  const VectorXd truth = VectorXd::LinSpaced(kParameters, -0.3, 0.3);
  const VectorXd features = problem.measure(truth, kSampleNoise);
  const SimulatorPosterior posterior = sampleMany(problem, features);
  expectLeastSquaresWhereSeen(posterior, features);
  EXPECT_GT(posterior.effective_sample_size, 3900.0);  // the response is linear: all weights are the same
  EXPECT_LT(posterior.simulations, 3 * 4000);
  const SimulatorPosterior unweighted = sampleMany(problem, features, 4000, true);
  expectLeastSquaresWhereSeen(unweighted, features);
  EXPECT_TRUE(unweighted.is_linear);
  // none of a draw, but those of the check at eight of them, by differences here
  EXPECT_LE(unweighted.simulations + 4000, posterior.simulations + 8 * 2 * kParameters);
}

TEST(ManyParameters, KeepPriorsOfAnyShape) {
  std::vector<ParameterSpec> unknown = testing::makeParameters(kParameters, 0.5, 2.0);
  unknown[20].prior = PriorSpec{NormalPrior{1.0, 0.1}};
  Problem problem(kSampleTimes, respondToSome, unknown, kSampleNoise);
  const VectorXd features = problem.measure(VectorXd::Constant(kParameters, 1.1), kSampleNoise);
  const SimulatorPosterior posterior = sampleMany(problem, features);
  ASSERT_TRUE(posterior.isReliable()) << posterior.message;
  EXPECT_NEAR(posterior.mean[20], 1.0, 0.008);
  EXPECT_NEAR(posterior.stddev[20], 0.1, 0.006);
  EXPECT_NEAR(posterior.mean[25], 1.25, 0.04);  // uniform in the parameter, though searched in its logarithm
  EXPECT_NEAR(posterior.stddev[25], 1.5 / std::sqrt(12.0), 0.03);
}

/// What the prior leaves free bends what it is added to, by several standard deviations of the noise.
TEST(ManyParameters, AreDrawnAboutABentResponse) {
  const auto bent = [](const VectorXd& x) {
    const VectorXd free = x.segment(kSeenParameters, kSeenParameters);
    return VectorXd(makeMixedMatrix() *
                    (x.head(kSeenParameters) + 0.3 * free + free.cwiseProduct(free.reverse())));
  };
  std::vector<ParameterSpec> unknown = testing::makeParameters(kParameters, -1.0, 1.0);
  for (ParameterSpec& parameter : unknown) {
    parameter.prior = PriorSpec{NormalPrior{0.1, 0.2}};
  }
  Problem problem(kSampleTimes, bent, unknown, kSampleNoise);
  const SimulatorPosterior posterior =
      sampleMany(problem, problem.measure(VectorXd::Constant(kParameters, 0.1), kSampleNoise), 500);
  EXPECT_TRUE(posterior.isReliable()) << posterior.message;
  EXPECT_GT(posterior.effective_sample_size,
            400.0);  // equal weights but for what bends out of the range of J
}

/// Twenty parameters bend the response by far more than its noise, and not as second derivatives say.
TEST(ManyParameters, AreUnreliableWhereTheResponseIsFarFromQuadratic) {
  const auto bent = [](const VectorXd& x) {
    VectorXd response = respondToSome(x);
    response.head(kSeenParameters) +=
        (6.0 * x.segment(kSeenParameters, kSeenParameters).array()).sin().matrix() -
        (5.0 * x.tail(kSeenParameters).array()).sin().matrix();
    return response;
  };
  Problem problem(kSampleTimes, bent, testing::makeParameters(kParameters, -1.0, 1.0), kSampleNoise);
  const VectorXd features = problem.measure(VectorXd::Constant(kParameters, 0.4), kSampleNoise);
  for (const bool is_linear : {false, true}) {
    const SimulatorPosterior posterior = sampleMany(problem, features, 500, is_linear);
    EXPECT_FALSE(posterior.isReliable());
    EXPECT_FALSE(posterior.is_linear);  // linear responses about its draws lead elsewhere
  }
}

/// Ten valleys b = a^2, hundreds of times as long as they are narrow: searches creep along them.
TEST(ManyParameters, AreOfOneMinimumWhereSearchesEndOnTheWayToIt) {
  constexpr Index kValleys = 10;
  const auto respond = [](const VectorXd& x) {
    VectorXd response(2 * kValleys);
    response << 100.0 * (x.tail(kValleys) - x.head(kValleys).cwiseAbs2()), 0.3 * x.head(kValleys);
    return response;
  };
  Problem problem(2 * kValleys, respond, testing::makeParameters(2 * kValleys, -1.0, 1.0), 0.2);
  const VectorXd truth = VectorXd::LinSpaced(2 * kValleys, 0.1, 0.6);
  SimulatorPosteriorOptions options;
  options.draws = 64;
  const SimulatorPosterior posterior =
      samplePosterior(problem.simulator, problem.model, {}, problem.measure(truth, 0.2),
                      VectorXd::Zero(2 * kValleys), MatrixXd(), options);
  EXPECT_EQ(posterior.message.find("several minima"), std::string::npos) << posterior.message;
}

/// The first parameter's sign does not matter.
TEST(ManyParameters, AreUnreliableWithTwoMinima) {
  const auto mirrored = [](const VectorXd& x) {
    VectorXd response = respondToSome(x);
    response += makeMixedMatrix().col(0) * (x[0] * x[0] - x[0]);
    return response;
  };
  Problem problem(kSampleTimes, mirrored, testing::makeParameters(kParameters, -1.0, 1.0), kSampleNoise);
  const SimulatorPosterior posterior =
      sampleMany(problem, problem.measure(VectorXd::Constant(kParameters, 0.5), kSampleNoise), 500, true);
  EXPECT_NE(posterior.message.find("several minima"), std::string::npos) << posterior.message;
}

}  // namespace
}  // namespace twinmap
