#include "kernels/surrogate/joint_precision.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/kernels/support/random_data.hpp"

namespace twinmap::gp {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using test::randomMatrix;

constexpr Index kAllPoints = 40, kWithSlopes = 25, kSlopeVariables = 2;

/// A function of three variables, in hundreds of units of noise, with its slopes with respect to two of them.
struct Samples {
  MatrixXd points, values;
  SlopeData slopes;
};

Samples makeSamples() {
  Samples samples{randomMatrix(3, kAllPoints, 5), MatrixXd(kAllPoints, 1), {MatrixXd(2 * kWithSlopes, 1), 2}};
  for (Index i = 0; i < kAllPoints; ++i) {
    const VectorXd x = samples.points.col(i);
    samples.values(i, 0) = 200.0 * std::sin(2.0 * x(0) + x(1)) + x(2);
    if (i < kWithSlopes) {
      samples.slopes.values(i, 0) = 400.0 * std::cos(2.0 * x(0) + x(1));
      samples.slopes.values(kWithSlopes + i, 0) = 200.0 * std::cos(2.0 * x(0) + x(1));
    }
  }
  return samples;
}

Samples select(const Samples& all, const std::vector<Index>& kept) {
  std::vector<Index> rows;
  for (Index v = 0; v < kSlopeVariables; ++v) {
    for (const Index i : kept) {
      if (i < kWithSlopes) {
        rows.push_back(v * kWithSlopes + i);
      }
    }
  }
  return {all.points(Eigen::all, kept),
          all.values(kept, Eigen::all),
          {all.slopes.values(rows, Eigen::all), kSlopeVariables}};
}

std::vector<Index> keepAllBut(Index every) {
  std::vector<Index> kept;
  for (Index i = 0; i < kAllPoints; ++i) {
    if (every == 0 || i % every != 0) {
      kept.push_back(i);
    }
  }
  return kept;
}

/// The oracle factorises the covariance of the points kept alone.
void expectFitOfKept(const SharedStructure& structure, const SharedHyperparameters& numbers,
                     const std::vector<Index>& kept, double tolerance) {
  const Samples all = makeSamples(), part = select(all, kept);
  const JointPrecision precision(structure, numbers, all.points, kWithSlopes, kSlopeVariables);
  JointFit found, expected;
  ASSERT_TRUE(precision.fitPoints(kept, part.values, part.slopes, found));
  ASSERT_TRUE(fitJointly(structure, numbers, part.points, part.values, part.slopes, expected));
  const double scale = expected.weights.cwiseAbs().maxCoeff();
  EXPECT_LT((found.weights - expected.weights).cwiseAbs().maxCoeff(), tolerance * scale);
  EXPECT_LT((found.residual - expected.residual).cwiseAbs().maxCoeff(), tolerance * 200.0);
  EXPECT_LT((found.variance - expected.variance).cwiseQuotient(expected.variance).cwiseAbs().maxCoeff(),
            tolerance);
  EXPECT_LT((found.coefficients - expected.coefficients).cwiseAbs().maxCoeff(), tolerance * 200.0);
}

SharedHyperparameters makeNumbers(double nugget) {
  return {(VectorXd(3) << 0.9, 1.4, 2.0).finished(), nugget, nugget};
}

TEST(JointPrecision, FitsAllPointsAsTheirOwnFactorisation) {
  expectFitOfKept({SmoothCovariance::kMatern52, Trend::kQuadratic, true}, makeNumbers(1e-6), keepAllBut(0),
                  1e-6);
}

TEST(JointPrecision, FitsAFoldAsItsOwnFactorisation) {
  for (const SmoothCovariance covariance :
       {SmoothCovariance::kSquaredExponential, SmoothCovariance::kMatern52}) {
    for (const Trend trend : {Trend::kLinear, Trend::kQuadratic}) {
      for (const Index every : {Index{2}, Index{5}, Index{20}}) {
        expectFitOfKept({covariance, trend, true}, makeNumbers(1e-6), keepAllBut(every), 1e-6);
      }
    }
  }
}

TEST(JointPrecision, WithTheSmallestNuggetIsAsNearAsRoundingAllows) {
  expectFitOfKept({SmoothCovariance::kMatern52, Trend::kLinear, true}, makeNumbers(1e-9), keepAllBut(5),
                  1e-3);
}

TEST(JointPrecision, OfPointsThatCoincideIsNotDefinite) {
  MatrixXd points = randomMatrix(3, kAllPoints, 5);
  points.col(1) = points.col(0);
  const JointPrecision precision({SmoothCovariance::kSquaredExponential, Trend::kLinear, true},
                                 makeNumbers(0.0), points, kWithSlopes, kSlopeVariables);
  JointFit fit;
  EXPECT_FALSE(precision.isDefinite());
  EXPECT_FALSE(precision.fitPoints(keepAllBut(5), MatrixXd::Zero(32, 1), {}, fit));
}

}  // namespace
}  // namespace twinmap::gp
