#include "kernels/sampling/box_mixture.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "kernels/linalg/decompositions.hpp"

namespace twinmap::importance {
namespace {

using Eigen::Index;
using Eigen::Matrix2d;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

struct Numbers {
  VectorXd picks;
  MatrixXd normals;
};

Numbers makeNumbers(Index dimensions, Index count) {
  std::mt19937_64 engine(7);
  std::uniform_real_distribution<double> uniform(1e-12, 1.0);
  std::normal_distribution<double> normal;
  Numbers numbers{VectorXd(count), MatrixXd(dimensions, count)};
  for (Index i = 0; i < count; ++i) {
    numbers.picks[i] = uniform(engine);
    for (Index k = 0; k < dimensions; ++k) {
      numbers.normals(k, i) = normal(engine);
    }
  }
  return numbers;
}

BoxMixture makeMixture() {
  const Matrix2d lower = (Matrix2d() << 0.2, 0.0, 0.1, 0.3).finished();
  return BoxMixture({{0.5, Vector2d(0.3, -0.4), lower}, {0.3, Vector2d(-0.5, 0.5), 0.5 * lower}});
}

double calcNormalDensity(const Vector2d& x, const Vector2d& mean, const Matrix2d& covariance) {
  const double determinant = covariance(0, 0) * covariance(1, 1) - covariance(0, 1) * covariance(1, 0);
  const Vector2d d = x - mean;
  const double square =
      covariance(1, 1) * d[0] * d[0] + covariance(0, 0) * d[1] * d[1] - 2.0 * covariance(0, 1) * d[0] * d[1];
  return std::exp(-0.5 * square / determinant) / (2.0 * M_PI * std::sqrt(determinant));
}

TEST(BoxMixture, DensitiesAreThoseOfTheTextbook) {
  const Matrix2d lower = (Matrix2d() << 0.2, 0.0, 0.1, 0.3).finished(),
                 covariance = lower * lower.transpose();
  MatrixXd points(2, 2);
  points << 0.1, 1.2, -0.3, 0.0;  // one of them outside the box
  const VectorXd found = makeMixture().calcLogDensities(points).array().exp();
  for (Index i = 0; i < 2; ++i) {
    const double expected = 0.5 * calcNormalDensity(points.col(i), {0.3, -0.4}, covariance) +
                            0.3 * calcNormalDensity(points.col(i), {-0.5, 0.5}, 0.25 * covariance) +
                            (i == 0 ? 0.2 / 4.0 : 0.0);
    EXPECT_NEAR(found[i], expected, 1e-12 * expected);
  }
}

/// Importance weights towards the uniform distribution must give back its moments.
TEST(BoxMixture, DrawsFollowTheDensity) {
  constexpr Index kCount = 20000;
  const Numbers numbers = makeNumbers(2, kCount);
  const BoxMixture mixture = makeMixture();
  const MatrixXd points = mixture.draw(numbers.picks, numbers.normals);
  VectorXd log_weights = -mixture.calcLogDensities(points);
  for (Index i = 0; i < kCount; ++i) {
    if (points.col(i).cwiseAbs().maxCoeff() > 1.0) {
      log_weights[i] = -INFINITY;
    }
  }
  EXPECT_LE(log_weights.maxCoeff(), std::log(4.0 / 0.2) + 1e-12);  // defensive: bounded
  const WeightedDraws draws = weigh(points, log_weights);
  const double error = 1.0 / std::sqrt(calcEffectiveSampleSize(draws));
  EXPECT_LT(calcMean(draws).cwiseAbs().maxCoeff(), 4.0 * error * std::sqrt(1.0 / 3.0));
  EXPECT_LT((calcCovariance(draws) - Matrix2d::Identity() / 3.0).cwiseAbs().maxCoeff(), 4.0 * error * 0.34);
}

/// Half of the points about each of two places, in the box's diagonal.
constexpr double kPlace = 0.7, kPlaceStddev = 0.02;

double calcLogDensityOfTwoPlaces(const Vector2d& x) {
  const Vector2d place = Vector2d::Constant(kPlace);
  const Matrix2d covariance = kPlaceStddev * kPlaceStddev * Matrix2d::Identity();
  return std::log(0.5 * calcNormalDensity(x, place, covariance) +
                  0.5 * calcNormalDensity(x, -place, covariance));
}

/// The share of draws from one normal distribution with those moments that would be near either: 4 %.
TEST(CoverDraws, FollowsTwoPlacesThatOneNormalDistributionWouldMiss) {
  constexpr Index kCount = 2000;
  const Numbers numbers = makeNumbers(2, kCount);
  MatrixXd points = kPlaceStddev * numbers.normals;
  for (Index i = 0; i < kCount; ++i) {
    points.col(i).array() += i % 2 == 0 ? kPlace : -kPlace;
  }
  const BoxMixture cover = coverDraws(weigh(points, VectorXd::Zero(kCount)), makeNumbers(1, 16).picks);
  const MatrixXd drawn = cover.draw(numbers.picks, numbers.normals);
  VectorXd log_weights = -cover.calcLogDensities(drawn);
  for (Index i = 0; i < kCount; ++i) {
    log_weights[i] += calcLogDensityOfTwoPlaces(drawn.col(i));
  }
  const WeightedDraws weighted = weigh(drawn, log_weights);
  EXPECT_GT(calcEffectiveSampleSize(weighted), 0.1 * kCount);
  EXPECT_LT(calcMean(weighted).cwiseAbs().maxCoeff(), 0.15);
}

TEST(MixLogDensities, SurvivesNumbersThatExpDoesNot) {
  MatrixXd log_densities(1, 2);
  log_densities << -2000.0, -2000.0 + std::log(3.0);
  EXPECT_NEAR(mixLogDensities(log_densities, Vector2d(0.5, 0.5))[0], -2000.0 + std::log(2.0), 1e-12);
}

}  // namespace
}  // namespace twinmap::importance
