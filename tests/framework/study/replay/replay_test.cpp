#include "framework/study/replay/replay.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace twinmap {
namespace {

using Eigen::VectorXd;

TEST(CalcFits, TreatsEachOutputAlone) {
  ResponseLayout layout;
  layout.output_names = {"a", "b"};
  layout.output_units = {"m", "m"};
  layout.times = VectorXd::LinSpaced(4, 0.0, 3.0);
  VectorXd measured(8), response(8), noise(8);
  measured << 1.0, -1.0, 1.0, -1.0, 5.0, 7.0, 5.0, 7.0;
  response << 1.1, -1.1, 1.1, -1.1, 5.0, 7.0, 5.0, 5.0;
  noise << 0.1, 0.1, 0.1, 0.1, 0.5, 0.5, 0.5, 0.5;
  const std::vector<OutputFit> fits = calcFits(measured, response, noise, layout);
  ASSERT_EQ(fits.size(), 2U);
  EXPECT_NEAR(fits[0].nrmse_pct, 10.0, 1e-9);
  EXPECT_NEAR(fits[0].rms_sd, 1.0, 1e-9);
  EXPECT_NEAR(fits[0].largest_sd, 1.0, 1e-9);
  EXPECT_NEAR(fits[1].nrmse_pct, 100.0, 1e-9);  // rms 1 of residual 2 at one of four, rms 1 about the mean 6
  EXPECT_NEAR(fits[1].rms_sd, 2.0, 1e-9);
  EXPECT_NEAR(fits[1].largest_sd, 4.0, 1e-9);
}

TEST(CalcFits, HasNoNumberWithoutNoise) {
  ResponseLayout layout;
  layout.output_names = {"a"};
  layout.output_units = {"m"};
  layout.times = VectorXd::LinSpaced(2, 0.0, 1.0);
  const VectorXd measured = layout.times;
  const std::vector<OutputFit> fits = calcFits(measured, VectorXd::Ones(2), VectorXd::Zero(2), layout);
  EXPECT_FALSE(std::isfinite(fits[0].rms_sd));
  EXPECT_TRUE(std::isfinite(fits[0].nrmse_pct));
}

}  // namespace
}  // namespace twinmap
