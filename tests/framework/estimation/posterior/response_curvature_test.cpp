#include "framework/estimation/posterior/draws/response_curvature.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "kernels/linalg/decompositions.hpp"
#include "tests/framework/estimation/posterior/surface.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using testing::Surface;

constexpr int kBentTimes = 12;
constexpr double kBentNoise = 0.1;

/// Of three parameters, with squares and products of them.
VectorXd respondBent(const VectorXd& x) {
  return VectorXd::NullaryExpr(kBentTimes, [&](Index i) {
    const double t = 0.3 + 0.2 * static_cast<double>(i);
    return x[0] * t + x[1] * std::cos(t) + x[2] * std::sin(2.0 * t) + 0.5 * x[0] * x[1] * t +
           0.3 * x[2] * x[2] * std::cos(3.0 * t) - 0.4 * x[0] * x[2];
  });
}

/// Half of the squared residual at a point, in units of the noise, less that of the linear response.
double calcExactBend(const Surface& surface, const LocalSurface& local, const VectorXd& point) {
  const VectorXd residual = (surface.features - respondBent(point)) / kBentNoise;
  const VectorXd apart = point - local.at;
  const double linear =
      local.chi_square - 2.0 * apart.dot(local.descent) + apart.dot(local.information * apart);
  return 0.5 * (residual.squaredNorm() - linear);
}

TEST(ResponseCurvature, IsExactOfAQuadraticResponse) {
  Surface surface(kBentTimes, respondBent, testing::makeParameters(3, -1.0, 1.0), kBentNoise,
                  VectorXd::Constant(3, 0.2));
  for (const double start : {0.15, -0.9}) {
    const std::vector<Basin> basins = surface.makeBasins(VectorXd::Constant(3, start));
    const std::optional<ResponseCurvature> curvature =
        ResponseCurvature::measure(surface.surface, basins.front());
    ASSERT_TRUE(curvature);
    const MatrixXd lower = linalg::calcCholesky(basins.front().covariance).lower;
    for (int i = 0; i < 5; ++i) {  // two standard deviations away
      VectorXd direction = VectorXd::NullaryExpr(
          3, [&](Index j) { return std::sin(1.0 + 2.0 * i + 0.7 * static_cast<double>(j)); });
      const VectorXd point = basins.front().local.at + 2.0 * lower * direction.normalized();
      const double exact = calcExactBend(surface, basins.front().local, point);
      EXPECT_NEAR(curvature->calcBend(point), exact, 2e-2 * std::abs(exact) + 2e-2);
      const VectorXd slope = curvature->calcBendSlope(point);
      for (Index j = 0; j < 3; ++j) {
        const VectorXd step = 1e-5 * VectorXd::Unit(3, j);
        const double difference = curvature->calcBend(point + step) - curvature->calcBend(point - step);
        EXPECT_NEAR(slope[j], difference / 2e-5, 1e-5 * slope.norm());
      }
    }
  }
}

}  // namespace
}  // namespace twinmap
