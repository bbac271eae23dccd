#include "framework/data/features/extrema.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "framework/base/random/random.hpp"
#include "framework/data/features/feature_extractor.hpp"
#include "framework/data/features/peaks.hpp"
#include "framework/data/noise/feature_noise.hpp"
#include "tests/framework/data/features/golden/peaks_golden.hpp"
#include "tests/framework/data/features/layouts.hpp"

namespace twinmap {
namespace {

Eigen::VectorXd toVector(const std::vector<double>& values) {
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

/// Tops of at least a prominence, but for the values next to the ends, where no parabola fits.
std::vector<int> getGoldenTops(double prominence) {
  std::vector<int> tops;
  for (std::size_t i = 0; i < peaks_golden::kTops.size(); ++i) {
    if (peaks_golden::kProminences[i] >= prominence) {
      tops.push_back(peaks_golden::kTops[i]);
    }
  }
  return tops;
}

TEST(Peaks, AreThoseOfScipy) {
  const Eigen::VectorXd values = toVector(peaks_golden::kValues);
  for (const double prominence : {0.0, 0.52, 1.1, 2.0, 4.0}) {
    std::vector<int> found;
    for (const Peak& peak : findPeaks(values, prominence, 3, 100)) {
      found.push_back(static_cast<int>(std::lround(peak.position)));
    }
    EXPECT_EQ(found, getGoldenTops(prominence)) << prominence;
  }
}

TEST(Peaks, OfAParabolaAreExactBetweenSamples) {
  Eigen::VectorXd values(9);
  for (int i = 0; i < 9; ++i) {
    values[i] = 7.0 - 0.3 * (i - 4.37) * (i - 4.37);
  }
  for (const int fit_samples : {3, 5, 7}) {
    const std::vector<Peak> peaks = findPeaks(values, 1.0, fit_samples, 5);
    ASSERT_EQ(peaks.size(), 1U);
    EXPECT_NEAR(peaks[0].position, 4.37, 1e-13);
    EXPECT_NEAR(peaks[0].value, 7.0, 1e-13);
  }
}

TEST(Peaks, OfEqualNeighboursAreOne) {
  const std::vector<Peak> peaks = findPeaks(toVector({0, 0, 2, 2, 0, 0, 1, 1}), 0.5, 3, 5);
  ASSERT_EQ(peaks.size(), 1U);  // the values 1, 1 at the end may still rise
  EXPECT_DOUBLE_EQ(peaks[0].position, 2.5);
}

TEST(Peaks, OfNoiseAloneAreRarerThanOneInAHundredWindows) {
  const RandomStream random(1, RandomPurpose::kTrainNoise);
  constexpr int kWindows = 400, kCount = 1000;
  constexpr double kNoiseStddevs = 8.0;  // the default prominence
  int false_peaks = 0;
  for (int window = 0; window < kWindows; ++window) {
    const Eigen::VectorXd noise = Eigen::VectorXd::NullaryExpr(
        kCount, [&](Eigen::Index i) { return random.calcNormal(window, static_cast<std::uint64_t>(i)); });
    false_peaks += static_cast<int>(findPeaks(noise, kNoiseStddevs, 5, 100).size());
  }
  EXPECT_LE(false_peaks, 4);
}

/// A damped oscillation exp(-d t) sin(w t), whose extrema are at tan(w t) = w / d.
struct Oscillation {
  double damping = 0.4, omega = 5.0;

  double calc(double t) const { return std::exp(-damping * t) * std::sin(omega * t); }
  double calcExtremumTime(int i) const {
    constexpr double kPi = 3.141592653589793;
    return (std::atan(omega / damping) + i * kPi) / omega;
  }
};

FeatureSpec makeExtrema(ExtremaKind kind, int peaks, double prominence) {
  return ExtremaFeatureSpec{{"y", {}}, {0.1, 0.01, 290}, kind, peaks, prominence, 5};
}

Eigen::VectorXd calcResponse(const Eigen::VectorXd& times, const Oscillation& oscillation = {}) {
  return times.unaryExpr([&](double t) { return oscillation.calc(t); });
}

TEST(Extrema, AreThoseOfADampedOscillation) {
  const std::vector<FeatureSpec> features{makeExtrema(ExtremaKind::kBoth, 2, 0.01)};
  const ResponseLayout layout = makeLayout(features);
  const FeatureExtractor extractor(features, layout);
  const Eigen::VectorXd found = extractor.extract(calcResponse(layout.times));
  const Oscillation oscillation;
  const int order[] = {0, 2, 1, 3};  // two maxima, then two minima
  for (int i = 0; i < 4; ++i) {
    const double time = oscillation.calcExtremumTime(order[i]);
    // the parabola leaves terms of third and fourth order: (w h)^2 of the curvature's scale
    EXPECT_NEAR(found[2 * i], oscillation.calc(time), 1e-4) << i;
    EXPECT_NEAR(found[2 * i + 1], time, 2e-4) << i;
  }
  EXPECT_EQ(extractor.getInfos()[0].name, "y maximum 1 value");
  EXPECT_EQ(extractor.getInfos()[0].unit, "m");
  EXPECT_EQ(extractor.getInfos()[7].name, "y minimum 2 time");
  EXPECT_EQ(extractor.getInfos()[7].unit, "s");
}

TEST(Extrema, AreSmoothInTheResponse) {
  const std::vector<FeatureSpec> features{makeExtrema(ExtremaKind::kMaxima, 1, 0.01)};
  const ResponseLayout layout = makeLayout(features);
  const FeatureExtractor extractor(features, layout);
  const auto calcTime = [&](double omega) {
    return extractor.extract(calcResponse(layout.times, {0.4, omega}))(1, 0);
  };
  for (double omega = 4.5; omega < 5.5; omega += 0.01) {
    const double slope = (calcTime(omega + 1e-4) - calcTime(omega - 1e-4)) / 2e-4;
    const double exact = (Oscillation{0.4, omega + 1e-4}.calcExtremumTime(0) -
                          Oscillation{0.4, omega - 1e-4}.calcExtremumTime(0)) /
                         2e-4;
    EXPECT_NEAR(slope, exact, 0.1 * std::abs(exact)) << omega;
  }
}

TEST(Extrema, ThatAreNotThereAreMissingAndLeaveTheOthers) {
  const std::vector<FeatureSpec> features{makeExtrema(ExtremaKind::kMaxima, 4, 0.01)};
  const ResponseLayout layout = makeLayout(features);
  const Eigen::VectorXd found = FeatureExtractor(features, layout).extract(calcResponse(layout.times));
  EXPECT_TRUE(found.head(4).allFinite());  // maxima at 0.3, 1.55 and 2.8 s
  EXPECT_TRUE(std::isnan(found[6]));
  EXPECT_TRUE(std::isnan(found[7]));
}

TEST(Extrema, OfAFailedSampleAreMissing) {
  const std::vector<FeatureSpec> features{makeExtrema(ExtremaKind::kBoth, 1, 0.01)};
  const ResponseLayout layout = makeLayout(features);
  Eigen::MatrixXd responses = calcResponse(layout.times).replicate(1, 2);
  responses.col(0).setConstant(std::nan(""));
  const Eigen::MatrixXd found = FeatureExtractor(features, layout).extract(responses);
  EXPECT_TRUE(found.col(0).array().isNaN().all());
  EXPECT_TRUE(found.col(1).allFinite());
}

TEST(Extrema, HaveTheNoiseOfTheirParabola) {
  // values c0 - c k^2 / 2 with little noise: to first order the top moves by first / (squares c) and rises by
  // the noise of c0, whose variance is fourths / (n fourths - squares^2)
  const FeatureSpec feature = ExtremaFeatureSpec{{"y", {}}, {0.0, 1.0, 9}, ExtremaKind::kMaxima, 1, 0.1, 5};
  const ResponseLayout layout = makeLayout({feature});
  const FeatureExtractor extractor({feature}, layout);
  constexpr double kCurvature = 2.0, kStddev = 1e-3;
  const Eigen::VectorXd response =
      layout.times.unaryExpr([](double t) { return 5.0 - 0.5 * kCurvature * (t - 4.0) * (t - 4.0); });
  const FeatureNoise noise(extractor, Eigen::VectorXd::Constant(9, kStddev), 1);
  const Eigen::MatrixXd covariance = noise.calcCovariance(response).toMatrix();
  constexpr double kSquares = 10.0, kFourths = 34.0, kRelative = 4 * 0.032;
  const double of_value = kStddev * kStddev * kFourths / (5 * kFourths - kSquares * kSquares);
  const double of_time = kStddev * kStddev / (kSquares * kCurvature * kCurvature);
  EXPECT_NEAR(covariance(0, 0), of_value, kRelative * of_value);
  EXPECT_NEAR(covariance(1, 1), of_time, kRelative * of_time);
}

}  // namespace
}  // namespace twinmap
