// A linear model y = k sin(t), theta = d cos(t), of which the misfit of a response is a closed form.
#include "framework/inference/measurement/measurement_faults.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "framework/inference/measurement/wrap_modulus.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr Index kTimes = 100;
constexpr double kNoise = 1e-3;

ResponseLayout makeLayout() {
  return {{"y", "theta"}, {"m", "rad"}, VectorXd::LinSpaced(kTimes, 0.0, 6.0), 0};
}

VectorXd makeResponse(double k, double d) {
  const VectorXd t = makeLayout().times;
  VectorXd response(2 * kTimes);
  response << k * t.array().sin().matrix(), d * t.array().cos().matrix();
  return response;
}

/// Chi-square beside the best k and d within [0.5, 2], missing samples left out; noise is left out, its
/// chi-square is that of one each.
double calcMisfit(const VectorXd& response) {
  double chi_square = static_cast<double>(response.size());
  const VectorXd there = response.array().isFinite().select(VectorXd::Ones(response.size()), 0.0);
  const VectorXd known = response.array().isFinite().select(response, 0.0);
  const VectorXd shape = makeResponse(1.0, 1.0).cwiseProduct(there);
  for (const Index first : {Index{0}, kTimes}) {
    const auto measured = known.segment(first, kTimes), mode = shape.segment(first, kTimes);
    const double best = std::clamp(measured.dot(mode) / mode.squaredNorm(), 0.5, 2.0);
    chi_square += (measured - best * mode).squaredNorm() / (kNoise * kNoise);
  }
  return chi_square;
}

std::string explain(const VectorXd& response) {
  return explainByFault(response, makeLayout(), calcMisfit(response), response.size(), calcMisfit);
}

TEST(MeasurementFaults, AUnitIsNamedWithItsOutput) {
  VectorXd response = makeResponse(1.0, 1.2);
  response.tail(kTimes) *= 57.29577951308232;
  EXPECT_EQ(explain(response),
            "theta is 57.3 times too large, as deg in the place of rad: divide it by 57.3");
  response = makeResponse(1.0, 1.2);
  response.head(kTimes) *= 1000.0;
  EXPECT_EQ(explain(response), "y is 1000 times too large, as mm in the place of m: divide it by 1000");
}

// Whatever is divided by a large number explains as much as no response.
TEST(MeasurementFaults, ADriftIsNoUnit) {
  VectorXd response = makeResponse(1.0, 1.2);
  response.head(kTimes) += 40.0 * makeLayout().times;
  EXPECT_EQ(explain(response), "y drifts by 40 m a second: subtract the drift");
  response = makeResponse(1.9, 1.2);
  response.head(kTimes) *= 100.0;
  EXPECT_EQ(explain(response), "y is 100 times too large, as cm in the place of m: divide it by 100");
}

TEST(MeasurementFaults, ASignAnOffsetAndSwappedColumnsAreNamed) {
  VectorXd response = makeResponse(1.0, 1.2);
  response.head(kTimes) *= -1.0;
  EXPECT_EQ(explain(response), "y is of the other sign: turn its sign");
  response = makeResponse(1.0, 1.2);
  response.tail(kTimes).array() += 0.25;
  EXPECT_EQ(explain(response), "theta has an offset of 0.25: subtract it");
  EXPECT_EQ(explain(-makeResponse(1.0, 1.2)), "all outputs are of the other sign: turn their signs");
  response << makeResponse(1.0, 1.2).tail(kTimes), makeResponse(1.0, 1.2).head(kTimes);
  EXPECT_EQ(explain(response), "the columns of y and theta are swapped");
}

TEST(MeasurementFaults, SpikesAreNamedWithTheirTimes) {
  const VectorXd times = makeLayout().times;
  VectorXd response = makeResponse(1.0, 1.2);
  response[40] += 0.4;
  EXPECT_EQ(explain(response), "y has a spike at 2.424 s: repair the recording, or empty the cell");
  response[43] -= 0.3;
  response[80] += 0.7;
  EXPECT_EQ(explain(response).rfind("y has spikes at 4.848 s, 2.424 s, 2.606 s: repair the recording", 0),
            0u);
  EXPECT_NEAR(times[43], 2.606, 1e-3);
}

TEST(MeasurementFaults, ASensorThatClipsIsNamed) {
  VectorXd response = makeResponse(1.0, 1.2);
  response.head(kTimes) = response.head(kTimes).cwiseMin(0.6).cwiseMax(-0.9);
  const auto clipped =
      (response.head(kTimes).array() == 0.6 || response.head(kTimes).array() == -0.9).count();
  EXPECT_EQ(explain(response), "y is clipped in " + std::to_string(clipped) +
                                   " samples: state what it can show, measurement.range");
}

TEST(MeasurementFaults, ASensorThatHoldsIsNamed) {
  VectorXd response = makeResponse(1.0, 1.2);
  response.segment(30, 20).setConstant(response[30]);
  EXPECT_EQ(explain(response), "y holds 0.9696 from 1.818 s to 2.97 s: empty these cells");
}

TEST(MeasurementFaults, ADriftFromZeroIsNamedWithItsRate) {
  VectorXd response = makeResponse(1.0, 1.2);
  response.tail(kTimes) -= 0.5 * makeLayout().times;
  EXPECT_EQ(explain(response), "theta drifts by -0.5 rad a second: subtract the drift");
}

TEST(MeasurementFaults, DegreesAreNotNamedOfAMetre) {
  VectorXd response = makeResponse(1.0, 1.2);
  response.head(kTimes) *= 57.29577951308232;
  EXPECT_EQ(explain(response), "y is 57.3 times too large: divide it by 57.3");
}

TEST(MeasurementFaults, ACounterThatWrapsIsNamedWithItsModulus) {
  for (const double modulus : {0.8, 0.55}) {
    VectorXd response = makeResponse(1.0, 1.2);
    response.head(kTimes) = response.head(kTimes).unaryExpr(
        [modulus](double y) { return y - modulus * std::round(y / modulus); });
    const std::string text = modulus == 0.8 ? "0.8" : "0.55", half = modulus == 0.8 ? "0.4" : "0.275";
    EXPECT_EQ(explain(response), "y jumps by " + text +
                                     " m again and again, as a counter that wraps: give measurement.unwrap: "
                                     "[y] and measurement.range: {y: [-" +
                                     half + ", " + half + "]}");
  }
}

/// Samples that move by 30 and 37 % of the modulus.
TEST(MeasurementFaults, AFastCounterThatWrapsIsNamedToo) {
  for (const double modulus : {0.2, 0.16}) {
    VectorXd response = makeResponse(1.0, 1.2);
    response.head(kTimes) = response.head(kTimes).unaryExpr(
        [modulus](double y) { return y - modulus * std::floor(y / modulus); });
    const std::string text = modulus == 0.2 ? "0.2" : "0.16";
    EXPECT_EQ(explain(response), "y jumps by " + text +
                                     " m again and again, as a counter that wraps: give measurement.unwrap: "
                                     "[y] and measurement.range: {y: [0, " +
                                     text + "]}");
  }
}

TEST(WrapModulus, IsThatOfWhatTurnsAlone) {
  const VectorXd times = VectorXd::LinSpaced(200, 0.0, 4.0);
  const VectorXd ramp = 30.0 * times + times.array().sin().matrix();
  const auto wrap = [&](double modulus) -> VectorXd {
    return ramp.unaryExpr([&](double y) { return y - modulus * std::floor(y / modulus); });
  };
  EXPECT_NEAR(findModulus(times, wrap(2.0)), 2.0, 1e-3);
  EXPECT_NEAR(findModulus(times, wrap(1.7)), 1.7, 1e-3);
  // thirteen samples a period, which move by up to 38 % of the modulus
  const VectorXd curved = VectorXd::NullaryExpr(200, [](Index i) {
    const double y = 0.07 * std::sin(0.5 * static_cast<double>(i));
    return y - 0.091 * std::floor(y / 0.091);
  });
  EXPECT_NEAR(findModulus(times, curved), 0.091, 2e-3 * 0.091);
  EXPECT_EQ(findModulus(times, ramp), 0.0);
  EXPECT_EQ(findModulus(times, (20.0 * times).array().sin()), 0.0);
  EXPECT_EQ(findModulus(times, VectorXd::Ones(200)), 0.0);
  const VectorXd jagged = VectorXd::NullaryExpr(200, [](Index i) { return std::sin(37.0 * i * i); });
  EXPECT_EQ(findModulus(times, jagged), 0.0);
}

TEST(MeasurementFaults, SeveralOutputsByOneFactorAreNamedTogether) {
  EXPECT_EQ(explain(57.29577951308232 * makeResponse(1.0, 1.2)),
            "y and theta are 57.3 times too large: divide each by 57.3");
  const VectorXd large = 1000.0 * makeResponse(1.0, 1.2);
  EXPECT_EQ(explainByFault(large, makeLayout(), calcMisfit(large), large.size(), calcMisfit, {"F"}),
            "y and theta are 1000 times too large, as mm in the place of m: divide each by 1000; in a linear "
            "machine the recording does not tell that from F being 1000 times too small: look which it is");
}

TEST(MeasurementFaults, NothingIsSaidOfAMisfitThatNoneOfThemExplains) {
  VectorXd response = makeResponse(1.0, 1.2);
  response += 0.3 * makeLayout().times.array().square().sin().matrix().replicate(2, 1);
  EXPECT_EQ(explain(response), "");
  EXPECT_EQ(explain(makeResponse(1.0, 1.2)), "");
}

}  // namespace
}  // namespace twinmap
