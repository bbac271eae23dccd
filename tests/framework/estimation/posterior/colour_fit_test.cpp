#include "framework/estimation/posterior/noise/colour_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "framework/base/random/random.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// `count` residuals, neighbours of correlation `rho`, about a constant.
ResidualSeries makeSeries(Index count, double rho, double constant) {
  ResidualSeries series{VectorXd(count), MatrixXd(count, 0),
                        std::vector<long>(static_cast<std::size_t>(count))};
  std::iota(series.lags.begin(), series.lags.end(), 0L);
  const RandomStream random(3, RandomPurpose::kPosterior);
  random.drawNormals(0, 0, series.residual.data(), static_cast<std::size_t>(count));
  for (Index i = 1; i < count; ++i) {
    series.residual[i] = rho * series.residual[i - 1] + std::sqrt(1.0 - rho * rho) * series.residual[i];
  }
  series.residual.array() += constant;
  return series;
}

TEST(ColourFit, IsFiniteWhereTheCorrelationReachesOne) {
  for (const double constant : {1e2, 1e4, 1e6}) {
    const std::vector<NoiseColour> colours = fitColours(makeSeries(100, 0.0, constant));
    ASSERT_FALSE(colours.empty()) << constant;
    for (const NoiseColour& colour : colours) {
      EXPECT_TRUE(colour.autoregression.allFinite() && std::isfinite(colour.log_weight)) << constant;
    }
  }
}

TEST(ColourFit, FindsACorrelationAndNoneInWhiteNoise) {
  EXPECT_TRUE(fitColours(makeSeries(300, 0.0, 0.0)).empty());
  const std::vector<NoiseColour> colours = fitColours(makeSeries(300, 0.6, 0.0));
  ASSERT_FALSE(colours.empty());
  EXPECT_NEAR(colours[colours.size() / 2].autoregression[0], 0.6, 0.15);  // the middle node
}

}  // namespace
}  // namespace twinmap
