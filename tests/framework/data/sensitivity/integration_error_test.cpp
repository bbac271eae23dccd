#include "framework/data/sensitivity/integration_error.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace twinmap {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kSteep = 1e6;  // the box says nothing beside such sensitivities

// All of an error along what a parameter does: sqrt(200) times as far as in one sample.
TEST(IntegrationError, CoherentErrorsFarBelowTheNoiseMoveAnEstimate) {
  const FeatureError point{VectorXd::Constant(200, 0.1), MatrixXd::Constant(200, 1, kSteep)};
  const IntegrationError found = calcIntegrationError({point}, 1);
  EXPECT_NEAR(found.shift, 0.1 * std::sqrt(200.0), 1e-9);
  EXPECT_NEAR(found.rise, 200 * 0.01 / std::sqrt(400.0), 1e-12);
  EXPECT_NEAR(found.calcDecades(), std::log10(std::sqrt(200.0)), 1e-9);
  EXPECT_FALSE(found.isNegligible());
}

TEST(IntegrationError, AcrossTheSensitivitiesItRaisesChiSquareAlone) {
  MatrixXd sensitivities = MatrixXd::Zero(4, 1);
  sensitivities.topRows(2).setConstant(kSteep);
  VectorXd error(4);
  error << 1.0, -1.0, 2.0, 0.0;
  const IntegrationError found = calcIntegrationError({{error, sensitivities}}, 1);
  EXPECT_NEAR(found.shift, 0.0, 1e-9);
  EXPECT_NEAR(found.rise, 6.0 / std::sqrt(8.0), 1e-12);
  EXPECT_NEAR(found.calcDecades(), 0.5 * std::log10(10.0 * found.rise), 1e-12);
}

// Beyond what the box leaves open nothing can be moved: a parameter that the features do not tell.
TEST(IntegrationError, DoesNotMoveWhatTheFeaturesDoNotTell) {
  const FeatureError point{VectorXd::Constant(2, 5.0), MatrixXd::Constant(2, 1, 1e-6)};
  EXPECT_LT(calcIntegrationError({point}, 1).shift, 1e-4);
}

TEST(IntegrationError, IsTheLargestOverPointsAndUpdatingParameters) {
  MatrixXd sensitivities(2, 3);
  sensitivities << kSteep, 0, 0, 0, kSteep, kSteep;
  const FeatureError small{VectorXd::Constant(2, 0.01), sensitivities};
  FeatureError large = small;
  large.error << 0.02, 0.5;
  const IntegrationError found = calcIntegrationError({small, large, small}, 2);
  EXPECT_EQ(found.parameter, 1);
  EXPECT_NEAR(calcIntegrationError({large}, 1).shift, 0.02, 1e-6);
  EXPECT_LE(found.shift, boundIntegrationError({small, large}).shift);
  EXPECT_EQ(found.rise, boundIntegrationError({large, small}).rise);
}

TEST(IntegrationError, OfNothingIsNegligible) {
  EXPECT_TRUE(boundIntegrationError({}).isNegligible());
  EXPECT_TRUE(boundIntegrationError({{VectorXd::Constant(100, 0.009), {}}}).isNegligible());
  EXPECT_FALSE(boundIntegrationError({{VectorXd::Constant(100, 0.011), {}}}).isNegligible());
}

}  // namespace
}  // namespace twinmap
