#include "framework/estimation/posterior/simulator_posterior.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "tests/framework/estimation/refined/problem.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using testing::makeMatrix;
using testing::makeVector;
using testing::Problem;
using testing::Response;

SimulatorPosterior sample(Problem& problem, const VectorXd& features, int draws = 2000,
                          const VectorXd& held = {}) {
  const auto u = static_cast<Index>(problem.model.getUnknown().size());
  SimulatorPosteriorOptions options;
  options.draws = draws;
  return samplePosterior(problem.simulator, problem.model, {}, features,
                         held.size() > 0 ? held : VectorXd(VectorXd::Zero(u)), MatrixXd(u, 0), options);
}

struct Moments {
  VectorXd mean, stddev;
};

/// Those of a posterior of two parameters within the bounds by the midpoint rule: the oracle.
Moments integrate(const Response& response, const std::vector<ParameterSpec>& unknown,
                  const VectorXd& measured, double noise_stddev, int cells = 1200) {
  VectorXd sum = VectorXd::Zero(2), squares = VectorXd::Zero(2);
  double mass = 0.0, reference = -1.0;
  for (int pass = 0; pass < 2; ++pass) {  // the least chi-square first, so that exponentials do not vanish
    for (int i = 0; i < cells; ++i) {
      for (int j = 0; j < cells; ++j) {
        VectorXd x(2);
        for (int k = 0; k < 2; ++k) {
          const Bounds& bounds = unknown[static_cast<std::size_t>(k)].bounds;
          x[k] = bounds.lower + (bounds.upper - bounds.lower) * ((k == 0 ? i : j) + 0.5) / cells;
        }
        const double chi_square = (measured - response(x)).squaredNorm() / (noise_stddev * noise_stddev);
        if (pass == 0) {
          reference = reference < 0.0 ? chi_square : std::min(reference, chi_square);
        } else {
          const double weight = std::exp(-0.5 * (chi_square - reference));
          mass += weight;
          sum += weight * x;
          squares += weight * x.cwiseProduct(x);
        }
      }
    }
  }
  const VectorXd mean = sum / mass;
  return {mean, (squares / mass - mean.cwiseProduct(mean)).cwiseSqrt()};
}

/// Means within .05 standard deviations, standard deviations within 5 %.
void expectMoments(const SimulatorPosterior& posterior, const Moments& expected) {
  ASSERT_TRUE(posterior.isReliable()) << posterior.message;
  for (Index j = 0; j < expected.mean.size(); ++j) {
    EXPECT_NEAR(posterior.mean[j], expected.mean[j], 0.05 * expected.stddev[j]);
    EXPECT_NEAR(posterior.stddev[j] / expected.stddev[j], 1.0, 0.05);
  }
}

void expectQuadrature(const Response& response, const std::vector<ParameterSpec>& unknown,
                      double noise_stddev, int times, const VectorXd& truth) {
  Problem problem(times, response, unknown, noise_stddev);
  const VectorXd features = problem.measure(truth, noise_stddev);
  expectMoments(sample(problem, features, 20000), integrate(response, unknown, features, noise_stddev));
}

TEST(SimulatorPosterior, IsThatOfQuadratureOnABanana) {
  expectQuadrature(
      [](const VectorXd& x) {
        return makeVector({0.3 * x[0], 2.0 * (x[1] - x[0] * x[0])});
      },
      testing::makeParameters(2, -1.0, 1.0), 0.2, 2, makeVector({0.2, 0.1}));
}

TEST(SimulatorPosterior, IsThatOfQuadratureWhereOnlyAProductIsSeen) {
  expectQuadrature([](const VectorXd& x) { return VectorXd::Constant(20, x[0] * x[1]); },
                   testing::makeParameters(2, 0.5, 5.0), 0.3, 20, makeVector({1.5, 2.0}));
}

TEST(SimulatorPosterior, ReachesTheEndsOfASumWithTheDrawsThatInferTakes) {
  // a ridge far thinner than it is long, which logarithms bend: where on it the search ends depends on the
  // seed
  const auto response = [](const VectorXd& x) -> VectorXd { return VectorXd::Constant(20, x[0] + x[1]); };
  const std::vector<ParameterSpec> unknown = testing::makeParameters(2, 0.5, 5.0);
  constexpr double kNoise = 0.05;
  Problem problem(20, response, unknown, kNoise);
  for (const double second : {0.6, 2.0, 4.5}) {
    const VectorXd features = problem.measure(makeVector({1.0, second}), kNoise);
    const Moments expected = integrate(response, unknown, features, kNoise, 600);
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      SimulatorPosteriorOptions options;
      options.seed = seed;
      const SimulatorPosterior posterior = samplePosterior(problem.simulator, problem.model, {}, features,
                                                           VectorXd::Zero(2), MatrixXd(2, 0), options);
      ASSERT_TRUE(posterior.isReliable()) << posterior.message;
      EXPECT_NEAR(posterior.mean[0], expected.mean[0], 0.2 * expected.stddev[0]);
      EXPECT_NEAR(posterior.stddev[0] / expected.stddev[0], 1.0, 0.1);
    }
  }
}

/// Only J + m L^2 is seen, to a ten-thousandth of what the bounds leave of J: of m and L what the bounds of J
/// leave is uniform.
TEST(SimulatorPosterior, FillsTheSurfaceOfABaseParameter) {
  std::vector<ParameterSpec> unknown = testing::makeParameters(3, 0.1, 0.25);  // J, m, L
  unknown[1].bounds = {0.5, 1.5, {}};
  unknown[2].bounds = {0.3, 0.6, {}};
  const auto calc = [](const VectorXd& x) { return x[0] + x[1] * x[2] * x[2]; };
  constexpr double kNoise = 1e-4;
  Problem problem(
      20, [=](const VectorXd& x) -> VectorXd { return VectorXd::Constant(20, calc(x)); }, unknown, kNoise);
  const VectorXd truth = makeVector({0.15, 1.1, 0.4});
  constexpr int kCells = 500;
  MatrixXd inside(3, kCells * kCells);
  Index count = 0;
  for (int i = 0; i < kCells; ++i) {
    for (int j = 0; j < kCells; ++j) {
      const double m = 0.5 + (i + 0.5) / kCells, l = 0.3 + 0.3 * (j + 0.5) / kCells;
      const double rest = calc(truth) - m * l * l;
      if (rest > 0.1 && rest < 0.25) {
        inside.col(count++) << rest, m, l;
      }
    }
  }
  inside.conservativeResize(3, count);
  const VectorXd mean = inside.rowwise().mean();
  const VectorXd stddev = (inside.colwise() - mean).rowwise().norm() / std::sqrt(static_cast<double>(count));
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const SimulatorPosterior posterior =
        sample(problem, problem.measure(truth, kNoise, seed), SimulatorPosteriorOptions{}.draws);
    ASSERT_TRUE(posterior.isReliable()) << posterior.message;
    EXPECT_EQ(posterior.modes.size(), 1U);
    for (Index j = 0; j < 3; ++j) {
      EXPECT_NEAR(posterior.mean[j], mean[j], 0.1 * stddev[j]);
      EXPECT_NEAR(posterior.stddev[j] / stddev[j], 1.0, 0.1);
    }
  }
}

/// Errors that all measurements share are none of chance: 512 independent draws have 5 % of a standard
/// deviation in the mean and 4 % in the standard deviation, whatever is measured.
TEST(SimulatorPosterior, HasTheMomentsOfANormalPosteriorWithTheDrawsThatInferTakes) {
  const MatrixXd matrix = MatrixXd::NullaryExpr(
      30, 4, [](Index i, Index j) { return std::sin(1.0 + 0.7 * static_cast<double>((i + 1) * (j + 1))); });
  constexpr double kNoise = 0.05;
  Problem problem(
      30, [=](const VectorXd& x) -> VectorXd { return matrix * x; }, testing::makeParameters(4, -2.0, 2.0),
      kNoise);
  const MatrixXd covariance = kNoise * kNoise * (matrix.transpose() * matrix).inverse();
  const VectorXd stddev = covariance.diagonal().cwiseSqrt();
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const VectorXd features = problem.measure(VectorXd::Constant(4, 0.2), kNoise, seed);
    const VectorXd mean = covariance * matrix.transpose() * features / (kNoise * kNoise);
    const SimulatorPosterior posterior = sample(problem, features, SimulatorPosteriorOptions{}.draws);
    ASSERT_TRUE(posterior.isReliable()) << posterior.message;
    EXPECT_LT((posterior.mean - mean).cwiseQuotient(stddev).cwiseAbs().maxCoeff(), 0.025);
    EXPECT_LT((posterior.stddev.cwiseQuotient(stddev).array() - 1.0).abs().maxCoeff(), 0.025);
  }
}

TEST(SimulatorPosterior, IsThatOfQuadratureAtABound) {
  const MatrixXd matrix = makeMatrix(10, 2);
  expectQuadrature([=](const VectorXd& x) -> VectorXd { return matrix * x; },
                   testing::makeParameters(2, 0.0, 1.0), 0.4, 10, makeVector({0.0, 1.0}));
}

TEST(SimulatorPosterior, IsThatOfQuadratureWithHeavyTails) {
  expectQuadrature(
      [](const VectorXd& x) {
        return makeVector({std::atan(4.0 * x[0]), std::atan(4.0 * x[1])});
      },
      testing::makeParameters(2, -1.0, 1.0), 0.3, 2, makeVector({0.3, -0.5}));
}

TEST(SimulatorPosterior, IsThatOfQuadratureOfEightParameters) {
  // four bananas, each more bent than the one before, that know nothing of each other
  const auto banana = [](const VectorXd& x, int k) {
    return makeVector({x[0], 2.0 * (x[1] - 0.3 * k * x[0] * x[0])});
  };
  const auto response = [&](const VectorXd& x) {
    VectorXd all(8);
    for (int k = 0; k < 4; ++k) {
      all.segment(2 * k, 2) = banana(x.segment(2 * k, 2), k);
    }
    return all;
  };
  constexpr double kNoise = 0.2;
  Problem problem(8, response, testing::makeParameters(8, -1.0, 1.0), kNoise);
  const VectorXd features = problem.measure(makeVector({0.2, 0.1, -0.3, 0.4, 0.8, -0.2, 0.5, 0.3}), kNoise);
  Moments expected{VectorXd(8), VectorXd(8)};
  for (int k = 0; k < 4; ++k) {
    const Moments pair =
        integrate([&](const VectorXd& x) { return banana(x, k); }, testing::makeParameters(2, -1.0, 1.0),
                  features.segment(2 * k, 2), kNoise, 300);
    expected.mean.segment(2 * k, 2) = pair.mean;
    expected.stddev.segment(2 * k, 2) = pair.stddev;
  }
  expectMoments(sample(problem, features, 10000), expected);
}

TEST(SimulatorPosterior, HasBothModesWhereASignIsNotSeen) {
  const auto response = [](const VectorXd& x) {
    return VectorXd(VectorXd::Constant(10, x[0] * x[0]) + VectorXd::LinSpaced(10, -1.0, 1.0) * x[1]);
  };
  const std::vector<ParameterSpec> unknown = testing::makeParameters(2, -1.0, 1.0);
  Problem problem(10, response, unknown, 0.02);
  const VectorXd features = problem.measure(makeVector({0.6, 0.2}), 0.02);
  const SimulatorPosterior posterior = sample(problem, features, 4000);
  expectMoments(posterior, integrate(response, unknown, features, 0.02));
  ASSERT_EQ(posterior.modes.size(), 2u);
  for (const PosteriorMode& mode : posterior.modes) {
    EXPECT_NEAR(mode.weight, 0.5, 0.05);
    EXPECT_NEAR(std::abs(mode.mean[0]), 0.6, 0.05);
  }
}

TEST(SimulatorPosterior, TakesARidgeForOneMode) {
  Problem problem(
      20, [](const VectorXd& x) { return VectorXd::Constant(20, x[0] * x[1]); },
      testing::makeParameters(2, 0.5, 5.0), 0.3);
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const SimulatorPosterior posterior =
        sample(problem, problem.measure(makeVector({1.5, 2.0}), 0.3, seed), 500);
    EXPECT_EQ(posterior.modes.size(), 1u);
  }
}

TEST(SimulatorPosterior, FindsTheDeepestOfManyBasins) {
  // a fast oscillation of one unknown frequency: chi-square has a minimum at every other period
  const auto response = [](const VectorXd& x) -> VectorXd {
    return (VectorXd::LinSpaced(40, 0.0, 6.0) * (10.0 + 4.0 * x[0])).array().sin() * (1.0 + 0.3 * x[1]);
  };
  Problem problem(40, response, testing::makeParameters(2, -1.0, 1.0), 0.05);
  for (const double truth : {-0.8, -0.2, 0.4, 0.9}) {
    const VectorXd features = problem.measure(makeVector({truth, 0.5}), 0.05);
    const SimulatorPosterior posterior = sample(problem, features, 500);
    ASSERT_TRUE(posterior.isReliable()) << posterior.message;
    EXPECT_TRUE(posterior.isExplained());
    EXPECT_NEAR(posterior.mean[0], truth, 4.0 * posterior.stddev[0]);
  }
}

TEST(SimulatorPosterior, ShowsTheFloorOfItsValleyWhereTooFewDrawsStandForIt) {
  Problem problem(
      10, [](const VectorXd& x) { return VectorXd::Constant(10, x[0] * x[1]); },
      testing::makeParameters(2, 0.5, 5.0), 0.3);
  const VectorXd features = problem.measure(makeVector({1.0, 2.0}), 0.3);
  const SimulatorPosterior posterior = sample(problem, features, 8);  // 8 rounds of 16 at most
  ASSERT_FALSE(posterior.isReliable());
  ASSERT_TRUE(posterior.isExplained());
  ASSERT_GE(posterior.places.cols(), 5);
  const Eigen::ArrayXd first = posterior.places.row(0).array();
  EXPECT_GT(first.maxCoeff() / first.minCoeff(), 2.0);
  for (const auto& place : posterior.places.colwise()) {
    EXPECT_NEAR(place[0] * place[1], features.mean(), 5.0 * 0.3 / std::sqrt(10.0));  // chi-square 25 above
  }
  const VectorXd product = posterior.floor.points.row(0).cwiseProduct(posterior.floor.points.row(1));
  EXPECT_TRUE(posterior.floor.determine(product));
  EXPECT_NEAR(posterior.floor.weights.dot(product), features.mean(), 0.2 * 0.3 / std::sqrt(10.0));
  EXPECT_FALSE(posterior.floor.determine(posterior.floor.points.row(0)));
}

TEST(SimulatorPosterior, HoldsKnownInputs) {
  Problem problem(
      5, [](const VectorXd& x) { return VectorXd::Constant(5, x[0] + x[1]); },
      testing::makeParameters(1, -20.0, 20.0), 0.2);
  const VectorXd features = VectorXd::Constant(5, 5.0);
  const SimulatorPosterior posterior = sample(problem, features, 2000, makeVector({0.0, 3.5}));
  ASSERT_TRUE(posterior.isReliable()) << posterior.message;
  EXPECT_NEAR(posterior.mean[0], 1.5, 0.1 * 0.2 / std::sqrt(5.0));
  EXPECT_NEAR(posterior.stddev[0], 0.2 / std::sqrt(5.0), 0.05 * 0.2 / std::sqrt(5.0));
}

TEST(SimulatorPosterior, SaysWhereNoiseDoesNotExplainTheMeasurement) {
  Problem problem(
      30, [](const VectorXd& x) { return VectorXd::Constant(30, x[0]); },
      testing::makeParameters(1, -1.0, 1.0), 0.1);
  const SimulatorPosterior posterior = sample(problem, VectorXd::LinSpaced(30, -1.0, 1.0));
  EXPECT_FALSE(posterior.isExplained());
  EXPECT_GT(posterior.chi_square, 900.0);
}

TEST(SimulatorPosterior, SaysWhereNothingCanBeSimulated) {
  Problem problem(
      3, [](const VectorXd&) { return VectorXd::Constant(3, std::nan("")); },
      testing::makeParameters(1, -1.0, 1.0), 0.1);
  const SimulatorPosterior posterior = sample(problem, VectorXd::Zero(3));
  EXPECT_EQ(posterior.message, "every search failed at its first simulation");
  EXPECT_FALSE(posterior.isExplained());
}

TEST(SimulatorPosterior, LeavesOutWhatFailsToSimulate) {
  Problem problem(
      5, [](const VectorXd& x) { return VectorXd::Constant(5, x[0] > 0.2 ? std::nan("") : x[0]); },
      testing::makeParameters(1, -1.0, 1.0), 0.5);
  const SimulatorPosterior posterior = sample(problem, VectorXd::Zero(5));
  ASSERT_TRUE(posterior.isReliable()) << posterior.message;
  for (Index i = 0; i < posterior.draws.cols(); ++i) {
    EXPECT_TRUE(posterior.weights[i] == 0.0 || posterior.draws(0, i) <= 0.2);
  }
  EXPECT_LT(posterior.mean[0], 0.0);
}

TEST(SimulatorPosterior, IsTheSameWhateverCameBefore) {
  Problem problem(
      10, [](const VectorXd& x) { return VectorXd::Constant(10, x[0] * x[1]); },
      testing::makeParameters(2, 0.5, 5.0), 0.3);
  const VectorXd features = problem.measure(makeVector({1.0, 2.0}), 0.3);
  const SimulatorPosterior first = sample(problem, features, 500);
  sample(problem, VectorXd::Constant(10, 9.0), 500);
  const SimulatorPosterior again = sample(problem, features, 500);
  EXPECT_EQ(first.draws, again.draws);
  EXPECT_EQ(first.weights, again.weights);
  EXPECT_EQ(first.simulations, again.simulations);
}

}  // namespace
}  // namespace twinmap
