#include "framework/estimation/posterior/noise/residual_loss.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>

#include "framework/estimation/posterior/noise/noise_candidates.hpp"
#include "framework/estimation/posterior/simulator_posterior.hpp"
#include "kernels/linalg/autocorrelation.hpp"
#include "tests/framework/estimation/refined/problem.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using testing::makeMatrix;
using testing::makeVector;
using testing::Problem;

constexpr double kSampleNoise = 0.05;

/// A straight line's two coefficients from samples.
Problem makeLine(const MatrixXd& matrix) {
  return Problem(
      static_cast<int>(matrix.rows()), [matrix](const VectorXd& x) -> VectorXd { return matrix * x; },
      testing::makeParameters(2, -1.0, 1.0), kSampleNoise);
}

NoiseHypothesis makeOutliers() {
  NoiseHypothesis hypothesis;
  hypothesis.has_outliers = true;
  return hypothesis;
}

NoiseHypothesis makeNoise(std::optional<double> factor, bool has_offset,
                          const std::vector<NoiseColour>& colours = {}) {
  NoiseHypothesis hypothesis;
  hypothesis.outputs.push_back({0, factor, has_offset, colours});
  return hypothesis;
}

NoiseHypothesis makeOutliersOfUnknownSize() {
  NoiseHypothesis hypothesis = makeNoise({}, false);
  hypothesis.has_outliers = true;
  return hypothesis;
}

const std::vector<NoiseColour> kColours{{makeVector({0.6}), 0.0}, {makeVector({0.7, -0.2}), -0.3}};

MatrixXd makeCorrelation(const std::vector<double>& autoregression, Index n) {
  const VectorXd rho = calcAutocorrelation(autoregression, n - 1);
  return MatrixXd::NullaryExpr(n, n, [&](Index i, Index j) { return rho[std::abs(i - j)]; });
}

SimulatorPosterior sampleWith(Problem& problem, const VectorXd& features, const NoiseHypothesis& noise,
                              int draws = 4000) {
  SimulatorPosteriorOptions options;
  options.draws = draws;
  PosteriorProblem posed{problem.model.getUnknown(), {}, {}, 2};
  posed.trials.push_back({&problem.simulator, &problem.model, features, VectorXd::Zero(2), {0, 1}, noise});
  return samplePosterior(posed, MatrixXd(2, 0), options);
}

TEST(ResidualLoss, LinearModelHasItsSlope) {
  Problem problem = makeLine(makeMatrix(8, 2));
  const VectorXd residual = makeVector({0.3, -1.2, 4.5, -60.0, 2.0, 0.5, -0.7, 1.1});
  NoiseHypothesis censored;
  censored.censored = {{2, 1.0}, {3, 1.0}, {4, -1.0}};
  constexpr double kStep = 1e-6;
  for (const NoiseHypothesis& hypothesis :
       {NoiseHypothesis{}, makeOutliers(), makeNoise({}, false), makeNoise(2.0, true), makeNoise({}, true),
        makeNoise({}, true, kColours), makeNoise(1.5, false, kColours), censored,
        makeOutliersOfUnknownSize()}) {
    const ResidualLoss loss(hypothesis, problem.model, problem.model.getWhole());
    const VectorXd descent = loss.linearize(residual, MatrixXd::Identity(8, 8)).descent;
    for (Index i = 0; i < residual.size(); ++i) {
      VectorXd up = residual, down = residual;
      up[i] += kStep;
      down[i] -= kStep;
      EXPECT_NEAR((loss.calc(up) - loss.calc(down)) / (2.0 * kStep), 2.0 * descent[i],
                  1e-6 * (1.0 + std::abs(descent[i])));
    }
  }
}

TEST(ResidualLoss, KnowsOutliersFromNoise) {
  Problem problem = makeLine(makeMatrix(5, 2));
  const ResidualLoss loss(makeOutliers(), problem.model, problem.model.getWhole());
  const VectorXd weights =
      loss.linearize(makeVector({0.0, 2.0, 3.0, 20.0, 500.0}), MatrixXd::Zero(5, 1)).weights;
  EXPECT_GT(weights.head(3).minCoeff(), 0.9);
  EXPECT_LT(weights.tail(2).maxCoeff(), 0.01);
}

TEST(ResidualLoss, ColouredLossIsThatOfTheCorrelationMatrix) {
  constexpr Index kCount = 8;
  Problem problem = makeLine(makeMatrix(kCount, 2));
  const VectorXd first = makeMatrix(kCount, 1), second = makeMatrix(kCount, 2).col(1);
  const std::vector<NoiseColour> one{kColours[1]};
  const MatrixXd correlation = makeCorrelation({0.7, -0.2}, kCount);
  const ResidualLoss stated(makeNoise(2.0, false, one), problem.model, problem.model.getWhole());
  const ResidualLoss unknown(makeNoise({}, false, one), problem.model, problem.model.getWhole());
  const auto calc_squares = [&](const VectorXd& r) { return r.dot(correlation.llt().solve(r)); };
  EXPECT_NEAR(stated.calc(first) - stated.calc(second), (calc_squares(first) - calc_squares(second)) / 4.0,
              1e-10);
  EXPECT_NEAR(unknown.calc(first) - unknown.calc(second),
              kCount * std::log(calc_squares(first) / calc_squares(second)), 1e-10);
}

TEST(ResidualLoss, UnknownNoiseGivesStudentsDistribution) {
  const MatrixXd matrix = makeMatrix(12, 2);
  Problem problem = makeLine(matrix);
  const VectorXd features = problem.measure(makeVector({0.1, -0.2}), 3.0 * kSampleNoise);
  const SimulatorPosterior posterior = sampleWith(problem, features, makeNoise({}, false));
  ASSERT_TRUE(posterior.isReliable()) << posterior.message;
  const Eigen::Matrix2d inverse = Eigen::Matrix2d(matrix.transpose() * matrix).inverse();
  const VectorXd mean = inverse * matrix.transpose() * features;
  // location and scale of least squares, n - 2 = 10 degrees of freedom: variance 10 / 8 times s^2
  const double squares = (features - matrix * mean).squaredNorm();
  for (Index j = 0; j < 2; ++j) {
    const double stddev = std::sqrt(squares / 8.0 * inverse(j, j));
    EXPECT_NEAR(posterior.mean[j], mean[j], 0.06 * stddev);
    EXPECT_NEAR(posterior.stddev[j] / stddev, 1.0, 0.06);
  }
  ASSERT_EQ(posterior.standardized.noise.size(), 1u);
  EXPECT_NEAR(posterior.standardized.noise[0].factor, std::sqrt(squares / 10.0) / kSampleNoise, 0.02);
}

TEST(ResidualLoss, AnOffsetIsAFurtherCoefficient) {
  const MatrixXd matrix = makeMatrix(30, 2);
  Problem problem = makeLine(matrix);
  const VectorXd features = problem.measure(makeVector({0.1, -0.2}), kSampleNoise).array() + 0.3;
  const SimulatorPosterior posterior = sampleWith(problem, features, makeNoise(1.0, true));
  ASSERT_TRUE(posterior.isReliable()) << posterior.message;
  MatrixXd with_constant(30, 3);
  with_constant << matrix, VectorXd::Ones(30);
  const Eigen::Matrix3d inverse = Eigen::Matrix3d(with_constant.transpose() * with_constant).inverse();
  const VectorXd mean = inverse * with_constant.transpose() * features;
  for (Index j = 0; j < 2; ++j) {
    const double stddev = kSampleNoise * std::sqrt(inverse(j, j));
    EXPECT_NEAR(posterior.mean[j], mean[j], 0.08 * stddev);
    EXPECT_NEAR(posterior.stddev[j] / stddev, 1.0, 0.06);
  }
  const FoundNoise& found = posterior.standardized.noise.at(0);
  EXPECT_NEAR(found.offset, mean[2], 0.1 * kSampleNoise);
  EXPECT_NEAR(found.offset_stddev / (kSampleNoise * std::sqrt(inverse(2, 2))), 1.0, 0.01);
}

TEST(ResidualLoss, SpikesCountForNothing) {
  const MatrixXd matrix = makeMatrix(40, 2);
  Problem problem = makeLine(matrix);
  const VectorXd clean = problem.measure(makeVector({0.1, -0.2}), kSampleNoise);
  VectorXd spiked = clean;
  spiked[7] += 5.0;
  spiked[22] -= 20.0;
  const SimulatorPosterior without = sampleWith(problem, clean, {});
  const SimulatorPosterior with = sampleWith(problem, spiked, makeOutliers());
  ASSERT_TRUE(with.isReliable()) << with.message;
  for (Index j = 0; j < 2; ++j) {
    EXPECT_NEAR(with.mean[j], without.mean[j], 0.7 * without.stddev[j]);
    EXPECT_NEAR(with.stddev[j] / without.stddev[j], 1.0, 0.15);
  }
}

TEST(ResidualLoss, SpikesInNoiseOfUnknownSizeCountForNothing) {
  const MatrixXd matrix = makeMatrix(60, 2);
  Problem problem = makeLine(matrix);
  const VectorXd clean = problem.measure(makeVector({0.1, -0.2}), 3.0 * kSampleNoise);
  VectorXd spiked = clean;
  spiked[7] += 15.0;
  spiked[42] -= 60.0;
  const SimulatorPosterior without = sampleWith(problem, clean, makeNoise({}, false));
  const SimulatorPosterior with = sampleWith(problem, spiked, makeOutliersOfUnknownSize());
  ASSERT_TRUE(with.isReliable()) << with.message;
  for (Index j = 0; j < 2; ++j) {
    EXPECT_NEAR(with.mean[j], without.mean[j], 0.7 * without.stddev[j]);
    EXPECT_NEAR(with.stddev[j] / without.stddev[j], 1.0, 0.15);
  }
  EXPECT_NEAR(with.standardized.noise.at(0).factor / without.standardized.noise.at(0).factor, 1.0, 0.1);
  EXPECT_LT(with.residual_weights[7], 0.01);
  EXPECT_GT(with.residual_weights[8], 0.5);
}

/// A line through samples whose noise has an autocorrelation of rho^k.
VectorXd measureColoured(Problem& problem, const MatrixXd& matrix, double rho, std::uint64_t seed) {
  const VectorXd line = matrix * makeVector({0.1, -0.2});
  const VectorXd white = problem.measure(makeVector({0.1, -0.2}), kSampleNoise, seed) - line;
  return line + makeCorrelation({rho}, line.size()).llt().matrixL() * white;
}

TEST(ResidualLoss, ColouredPosteriorIsThatOfADenseGrid) {
  constexpr Index kCount = 80;
  MatrixXd matrix(kCount, 2);
  const VectorXd times = VectorXd::LinSpaced(kCount, -1.0, 1.0);
  matrix << times, (8.0 * times.array()).sin().matrix();
  Problem problem = makeLine(matrix);
  const VectorXd features = measureColoured(problem, matrix, 0.7, 3);
  const VectorXd residual = (features - matrix * makeVector({0.1, -0.2})) / kSampleNoise;
  const std::vector<NoiseHypothesis> listed =
      listNoiseHypotheses({}, {&problem.model, residual, matrix / kSampleNoise});
  const NoiseHypothesis& coloured = listed.back();
  ASSERT_FALSE(coloured.outputs.at(0).colours.empty());
  ASSERT_EQ(coloured.outputs[0].colours[0].autoregression.size(), 1);
  const SimulatorPosterior posterior = sampleWith(problem, features, coloured, 1500);
  ASSERT_TRUE(posterior.isReliable()) << posterior.message;

  // given rho: Student's with n - 2 degrees of freedom; rho: its restricted likelihood, uniform
  double sum = 0.0;
  VectorXd mean = VectorXd::Zero(2), square = VectorXd::Zero(2);
  double least = 1e300;
  for (const bool weigh : {false, true}) {
    for (double rho = -0.1; rho < 0.995; rho += 0.005) {
      const Eigen::LLT<MatrixXd> factor(makeCorrelation({rho}, kCount));
      const MatrixXd x = factor.matrixL().solve(matrix);
      const VectorXd y = factor.matrixL().solve(features);
      const Eigen::Matrix2d information = x.transpose() * x;
      const VectorXd at = information.inverse() * x.transpose() * y;
      const double squares = (y - x * at).squaredNorm();
      const double log_determinant = 2.0 * MatrixXd(factor.matrixL()).diagonal().array().log().sum();
      const double misfit =
          log_determinant + std::log(information.determinant()) + (kCount - 2) * std::log(squares);
      least = weigh ? least : std::min(least, misfit);
      const double weight = weigh ? std::exp(-0.5 * (misfit - least)) : 0.0;
      sum += weight;
      mean += weight * at;
      square += weight * (at.cwiseAbs2() + squares / (kCount - 4) * information.inverse().diagonal());
    }
  }
  mean /= sum;
  for (Index j = 0; j < 2; ++j) {
    const double stddev = std::sqrt(square[j] / sum - mean[j] * mean[j]);
    EXPECT_NEAR(posterior.mean[j], mean[j], 0.12 * stddev);
    EXPECT_NEAR(posterior.stddev[j] / stddev, 1.0, 0.1);
  }
}

TEST(ResidualLoss, ClippedSamplesSayThatTheResponseIsBeyond) {
  const MatrixXd matrix = makeMatrix(20, 1).cwiseAbs();
  Problem problem(
      20, [matrix](const VectorXd& x) -> VectorXd { return matrix * x; },
      testing::makeParameters(1, 0.5, 1.5), kSampleNoise);
  constexpr double kLimit = 0.8;
  VectorXd features = problem.measure(makeVector({1.0}), kSampleNoise);
  NoiseHypothesis noise;
  for (Index i = 0; i < features.size(); ++i) {
    if (features[i] >= kLimit) {
      features[i] = kLimit;
      noise.censored.push_back({i, 1.0});
    }
  }
  ASSERT_GT(noise.censored.size(), 3u);
  SimulatorPosteriorOptions options;
  options.draws = 4000;
  PosteriorProblem posed{problem.model.getUnknown(), {}, {}, 1};
  posed.trials.push_back({&problem.simulator, &problem.model, features, VectorXd::Zero(1), {0}, noise});
  const SimulatorPosterior posterior = samplePosterior(posed, MatrixXd(1, 0), options);
  ASSERT_TRUE(posterior.isReliable()) << posterior.message;
  double sum = 0.0, first = 0.0, second = 0.0;
  for (double x = 0.5; x <= 1.5; x += 1e-4) {
    double log_likelihood = 0.0;
    for (Index i = 0; i < features.size(); ++i) {
      const double z = (features[i] - matrix(i, 0) * x) / kSampleNoise;
      log_likelihood += features[i] >= kLimit ? std::log(0.5 * std::erfc(z / std::sqrt(2.0))) : -0.5 * z * z;
    }
    const double weight = std::exp(log_likelihood);
    sum += weight;
    first += weight * x;
    second += weight * x * x;
  }
  const double mean = first / sum, stddev = std::sqrt(second / sum - mean * mean);
  EXPECT_NEAR(posterior.mean[0], mean, 0.06 * stddev);
  EXPECT_NEAR(posterior.stddev[0] / stddev, 1.0, 0.05);
}

}  // namespace
}  // namespace twinmap
