#include "framework/estimation/ridges/sum_coordinates.hpp"

#include <gtest/gtest.h>

#include "tests/framework/support/linear_simulator.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using Eigen::VectorXi;

VectorXi makeTerm(int a, int b, int c) {
  VectorXi term(3);
  term << a, b, c;
  return term;
}

/// a + 2 b c^2 of a, b, c.
const std::vector<Ridge> kRidges{{{0, 1, 2}, 2, {{{makeTerm(1, 0, 0), makeTerm(0, 1, 2)}, {1.0, 2.0}, 0.0}}}};
const std::vector<ParameterSpec> kUnknown = testing::makeParameters(3, 0.5, 2.0);

TEST(SumCoordinates, PutASumInThePlaceOfTheParameterThatItContainsAlone) {
  EXPECT_EQ(SumCoordinates::listReplaced(kUnknown, kRidges), std::vector<Index>{0});
  const SumCoordinates sums(kUnknown, kRidges);
  const LogCoordinates coordinates(kUnknown, {0});
  // a = 1, b = 2, c = 0.5 of a sum that is at most 2 + 2 * 2^3 = 18
  const VectorXd v = coordinates.fromParameters(Vector3d(1.0, 2.0, 0.5)), z = sums.toSums(v);
  EXPECT_NEAR(z[0], 2.0 / 18.0, 1e-15);
  EXPECT_EQ(z.tail(2), v.tail(2));
  EXPECT_TRUE(sums.fromSums(z).isApprox(v, 1e-14));
}

TEST(SumCoordinates, LeadBeyondTheBounds) {
  const SumCoordinates sums(kUnknown, kRidges);
  const LogCoordinates coordinates(kUnknown, {0});
  VectorXd z = sums.toSums(coordinates.fromParameters(Vector3d(1.0, 1.0, 1.0)));
  z[0] -= 3.0 / 18.0;  // a = -2: 4.33 half-widths below the centre 1.25
  EXPECT_NEAR(sums.fromSums(z)[0], (-2.0 - 1.25) / 0.75, 1e-13);
}

TEST(SumCoordinates, HaveTheSlopesOfTheirDifferences) {
  const SumCoordinates sums(kUnknown, kRidges);
  const VectorXd v = Vector3d(0.2, -0.4, 0.6), z = sums.toSums(v);
  constexpr double kStep = 1e-6;
  MatrixXd expected(3, 3);
  for (Index j = 0; j < 3; ++j) {
    const VectorXd step = kStep * VectorXd::Unit(3, j);
    expected.col(j) = (sums.fromSums(z + step) - sums.fromSums(z - step)) / (2.0 * kStep);
  }
  EXPECT_TRUE(sums.calcSlopes(v).isApprox(expected, 1e-8));
}

TEST(SumCoordinates, AreNoneOfProductsAndOfWhatIsInSeveralTerms) {
  const std::vector<Ridge> product{{{0, 1}, 1, {{{makeTerm(1, 1, 0)}, {1.0}, 0.0}}}};
  EXPECT_TRUE(SumCoordinates(kUnknown, product).isEmpty());
  const std::vector<Ridge> square{{{0, 1}, 1, {{{makeTerm(1, 0, 0), makeTerm(2, 1, 0)}, {1.0, 1.0}, 0.0}}}};
  EXPECT_TRUE(SumCoordinates(kUnknown, square).isEmpty());
}

}  // namespace
}  // namespace twinmap
