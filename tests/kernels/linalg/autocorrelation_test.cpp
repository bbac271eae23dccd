#include "kernels/linalg/autocorrelation.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace twinmap {
namespace {

TEST(Autocorrelation, OfFirstOrderIsGeometric) {
  const Eigen::VectorXd rho = calcAutocorrelation({-0.7}, 12);
  for (int k = 0; k <= 12; ++k) {
    EXPECT_NEAR(rho[k], std::pow(-0.7, k), 1e-15);
  }
}

// Roots r exp(+-i w): rho_k = r^k (cos w k + (1 - r^2) / (1 + r^2) cot w sin w k) (Box, Jenkins: Time Series
// Analysis, 3.2.4).
TEST(Autocorrelation, OfSecondOrderIsADampedOscillation) {
  constexpr double kR = 0.9, kW = 0.6;
  const Eigen::VectorXd rho = calcAutocorrelation({2.0 * kR * std::cos(kW), -kR * kR}, 30);
  for (int k = 0; k <= 30; ++k) {
    const double sine = (1.0 - kR * kR) / (1.0 + kR * kR) / std::tan(kW) * std::sin(kW * k);
    EXPECT_NEAR(rho[k], std::pow(kR, k) * (std::cos(kW * k) + sine), 1e-13);
  }
}

TEST(Autocorrelation, OfSecondOrderIsStationaryWithinTheTriangle) {
  for (double a1 = -2.5; a1 < 2.6; a1 += 0.3) {
    for (double a2 = -1.25; a2 < 1.3; a2 += 0.3) {
      EXPECT_EQ(isStationary({a1, a2}), a2 > -1.0 && a2 + a1 < 1.0 && a2 - a1 < 1.0) << a1 << ", " << a2;
    }
  }
  EXPECT_TRUE(isStationary({}));
  EXPECT_FALSE(isStationary({1.0}));
}

TEST(Autocorrelation, IsPositiveDefiniteWhereItsMatrixIs) {
  for (const double r : {0.3, 0.49, 0.51, 0.6, -0.52, -0.7}) {
    for (const Eigen::Index count : {2, 3, 6, 40}) {
      Eigen::VectorXd rho = Eigen::VectorXd::Zero(count);
      rho.head(2) << 1.0, r;
      // Its eigenvalues are 1 + 2 r cos(pi k / (count + 1)).
      const double smallest = 1.0 - 2.0 * std::abs(r) * std::cos(M_PI / (static_cast<double>(count) + 1.0));
      EXPECT_EQ(isPositiveDefinite(rho), smallest > 0.0) << r << ", " << count;
    }
  }
}

TEST(Lags, AreMultiplesOfTheSampleTimeOrNone) {
  EXPECT_EQ(findLags({0.2, 0.3, 0.7}, 0.1), (std::vector<long>{0, 1, 5}));
  EXPECT_EQ(findLags({0.2, 0.25}, 0.1), std::vector<long>{});
}

}  // namespace
}  // namespace twinmap
