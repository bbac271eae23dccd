#include "framework/data/features/spectrum.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>

#include "framework/data/features/feature_extractor.hpp"
#include "framework/data/noise/feature_noise.hpp"
#include "tests/framework/data/features/layouts.hpp"

namespace twinmap {
namespace {

constexpr double kTwoPi = 6.283185307179586;
const WindowSpec kWindow{0.3, 0.05, 40};  // lines at multiples of 0.5 Hz

FeatureSpec makeSpectrum(const std::vector<double>& frequencies, WindowFunction function,
                         ComplexParts parts) {
  SpectrumFeatureSpec feature{{{"y", {}}}, kWindow, {}, function, parts};
  for (const double frequency : frequencies) {
    feature.frequencies.push_back({frequency, {}});
  }
  return feature;
}

FeatureSpec makeFrequencyResponse(const std::vector<double>& frequencies, ComplexParts parts) {
  FrequencyResponseFeatureSpec feature{{"F", {}}, {{"y", {}}}, kWindow, {}, parts};
  for (const double frequency : frequencies) {
    feature.frequencies.push_back({frequency, {}});
  }
  return feature;
}

Eigen::VectorXd calcSine(const Eigen::VectorXd& times, double amplitude, double frequency, double phase) {
  return times.unaryExpr([=](double t) { return amplitude * std::sin(kTwoPi * frequency * t + phase); });
}

TEST(Spectrum, OfASineOnALineIsItsAmplitudeAndPhase) {
  for (const WindowFunction function : {WindowFunction::kRectangular, WindowFunction::kHann}) {
    const std::vector<FeatureSpec> features{makeSpectrum({1.5, 4}, function, ComplexParts::kRealImaginary)};
    const ResponseLayout layout = makeLayout(features);
    const Eigen::VectorXd found =
        FeatureExtractor(features, layout)
            .extract(calcSine(layout.times, 3.0, 1.5, 0.7) + calcSine(layout.times, 0.2, 4.0, -2.0) +
                     calcSine(layout.times, 50.0, 6.0, 1.0));
    EXPECT_NEAR(found[0], 3.0 * std::sin(0.7), 1e-12);  // A exp(j (phi - pi/2))
    EXPECT_NEAR(found[1], -3.0 * std::cos(0.7), 1e-12);
    EXPECT_NEAR(found[2], 0.2 * std::sin(-2.0), 1e-12);
    EXPECT_NEAR(found[3], -0.2 * std::cos(-2.0), 1e-12);
  }
}

TEST(Spectrum, IgnoresTheMean) {
  const std::vector<FeatureSpec> features{
      makeSpectrum({0.5, 9.5}, WindowFunction::kRectangular, ComplexParts::kRealImaginary),
      makeSpectrum({1.0, 9.5}, WindowFunction::kHann, ComplexParts::kRealImaginary)};
  const ResponseLayout layout = makeLayout(features);
  const Eigen::VectorXd found =
      FeatureExtractor(features, layout).extract(Eigen::VectorXd::Constant(layout.times.size(), 7.0));
  EXPECT_LT(found.cwiseAbs().maxCoeff(), 1e-13);
}

TEST(Spectrum, MagnitudeAndPhaseAreWithoutJumps) {
  const std::vector<FeatureSpec> features{
      makeSpectrum({2.0}, WindowFunction::kHann, ComplexParts::kMagnitudePhase)};
  const ResponseLayout layout = makeLayout(features);
  const FeatureExtractor extractor(features, layout);
  EXPECT_FALSE(extractor.isLinear());
  EXPECT_EQ(extractor.getInfos()[0].name, "|y| at 2 Hz");
  EXPECT_EQ(extractor.getInfos()[0].unit, "m");
  EXPECT_EQ(extractor.getInfos()[1].name, "cos phase y at 2 Hz");
  EXPECT_EQ(extractor.getInfos()[2].unit, "");
  for (double phase = 0.0; phase < kTwoPi; phase += 0.1) {
    const Eigen::VectorXd found = extractor.extract(calcSine(layout.times, 3.0, 2.0, phase));
    EXPECT_NEAR(found[0], 3.0, 1e-12);
    EXPECT_NEAR(found[1], std::sin(phase), 1e-12);
    EXPECT_NEAR(found[2], -std::cos(phase), 1e-12);
  }
}

TEST(Spectrum, NoiseIsTwoOverTheCountOnEveryLine) {
  // the variance of (2 / N) sum cos^2 is 2 / N of the samples' for real and imaginary parts, uncorrelated
  const std::vector<FeatureSpec> features{
      makeSpectrum({0.5, 3.0}, WindowFunction::kRectangular, ComplexParts::kRealImaginary)};
  const ResponseLayout layout = makeLayout(features);
  const FeatureExtractor extractor(features, layout);
  const FeatureNoise noise(extractor, Eigen::VectorXd::Constant(layout.times.size(), 0.2), 1);
  const Eigen::MatrixXd expected = 0.2 * 0.2 * 2.0 / kWindow.count * Eigen::MatrixXd::Identity(4, 4);
  EXPECT_LT((noise.calcCovariance(Eigen::VectorXd::Zero(layout.times.size())).toMatrix() - expected).norm(),
            1e-17);
}

TEST(Spectrum, NoiseOfMagnitudeIsRayleighWithoutASignalAndNormalWithALargeOne) {
  const std::vector<FeatureSpec> features{
      makeSpectrum({3.0}, WindowFunction::kRectangular, ComplexParts::kMagnitudePhase)};
  const ResponseLayout layout = makeLayout(features);
  const FeatureExtractor extractor(features, layout);
  const FeatureNoise noise(extractor, Eigen::VectorXd::Constant(layout.times.size(), 0.2), 1);
  const double variance = 0.2 * 0.2 * 2.0 / kWindow.count;  // of real and imaginary part
  constexpr double kRelative = 4 * 0.032;
  const double rayleigh = (2.0 - 0.25 * kTwoPi) * variance;
  EXPECT_NEAR(noise.calcCovariance(Eigen::VectorXd::Zero(layout.times.size()))(0, 0), rayleigh,
              kRelative * rayleigh);
  // phase pi/4 off: cosine and sine are turned alike by the noise of the phase, variance / A^2
  constexpr double kAmplitude = 100.0;
  const Eigen::MatrixXd large =
      noise.calcCovariance(calcSine(layout.times, kAmplitude, 3.0, 0.125 * kTwoPi)).toMatrix();
  EXPECT_NEAR(large(0, 0), variance, kRelative * variance);
  const double of_cosine = 0.5 * variance / (kAmplitude * kAmplitude);
  EXPECT_NEAR(large(1, 1), of_cosine, kRelative * of_cosine);
  EXPECT_NEAR(large(1, 2), of_cosine, kRelative * of_cosine);
}

TEST(FrequencyResponse, IsTheRatioOfOutputToExcitation) {
  const std::vector<FeatureSpec> features{makeFrequencyResponse({1.5, 4}, ComplexParts::kRealImaginary),
                                          makeFrequencyResponse({4}, ComplexParts::kMagnitudePhase)};
  const ResponseLayout layout = makeLayout(features);
  const Eigen::VectorXd force =
      calcSine(layout.times, 3.0, 1.5, 0.7) + calcSine(layout.times, 0.5, 4.0, -2.0);
  const InputSignals inputs{{"F"}, {"N"}, force};
  const FeatureExtractor extractor(features, layout, inputs);
  const Eigen::VectorXd response =
      calcSine(layout.times, 6.0, 1.5, 0.7 - 0.4) + calcSine(layout.times, 0.1, 4.0, -2.0 - 3.0);
  const Eigen::VectorXd found = extractor.extract(response);
  EXPECT_NEAR(found[0], 2.0 * std::cos(0.4), 1e-12);
  EXPECT_NEAR(found[1], -2.0 * std::sin(0.4), 1e-12);
  EXPECT_NEAR(found[2], 0.2 * std::cos(3.0), 1e-12);
  EXPECT_NEAR(found[3], -0.2 * std::sin(3.0), 1e-12);
  EXPECT_NEAR(found[4], 0.2, 1e-12);
  EXPECT_NEAR(found[5], std::cos(3.0), 1e-12);
  EXPECT_NEAR(found[6], -std::sin(3.0), 1e-12);
  EXPECT_EQ(extractor.getInfos()[0].name, "Re y/F at 1.5 Hz");
  EXPECT_EQ(extractor.getInfos()[0].unit, "m/N");
  EXPECT_EQ(extractor.getInfos()[4].name, "|y/F| at 4 Hz");

  const FeatureExtractor linear({features[0]}, layout, inputs);
  const FeatureNoise noise(linear, Eigen::VectorXd::Constant(layout.times.size(), 0.2), 1);
  const double of_line = 0.2 * 0.2 * 2.0 / kWindow.count;
  const Eigen::Vector4d expected(of_line / 9, of_line / 9, of_line * 4, of_line * 4);
  const Eigen::MatrixXd covariance = noise.calcCovariance(response).toMatrix();
  EXPECT_LT((covariance - Eigen::MatrixXd(expected.asDiagonal())).norm(), 1e-16);
}

TEST(FrequencyResponse, NeedsEnergyInTheExcitation) {
  std::vector<FeatureSpec> features{makeFrequencyResponse({1.5, 2.5}, ComplexParts::kRealImaginary)};
  std::get<FrequencyResponseFeatureSpec>(features[0]).frequencies[1].where = {"some.yaml", 7, 9,
                                                                              "frequencies[1]"};
  const ResponseLayout layout = makeLayout(features);
  const InputSignals inputs{{"F"}, {"N"}, calcSine(layout.times, 3.0, 1.5, 0.7)};
  try {
    const FeatureExtractor refused(features, layout, inputs);
    FAIL();
  } catch (const ExperimentError& error) {
    EXPECT_STREQ(error.what(),
                 "some.yaml:7:9: frequencies[1]: '2.5' is a frequency at which excitation 'F' has no energy "
                 "within the window");
  }
  EXPECT_THROW(FeatureExtractor(features, layout), std::invalid_argument);
}

// Magnitude, cosine and sine say what real and imaginary part say, whose noise does not depend on the
// response.
TEST(Spectrum, OfMagnitudesAndPhasesHasALinearForm) {
  const SamplesFeatureSpec samples{{{"y", {}}}, 0.3, 0.05, 3};
  const std::vector<double> frequencies{1.5, 4};
  const std::vector<FeatureSpec> shown{
      samples, makeSpectrum(frequencies, WindowFunction::kHann, ComplexParts::kMagnitudePhase), samples};
  const std::vector<FeatureSpec> parts{
      samples, makeSpectrum(frequencies, WindowFunction::kHann, ComplexParts::kRealImaginary), samples};
  const ResponseLayout layout = makeLayout(shown);
  const FeatureExtractor extractor(shown, layout), expected(parts, layout);
  ASSERT_TRUE(extractor.hasLinearForm());
  EXPECT_FALSE(expected.hasLinearForm());
  const FeatureExtractor linear = extractor.makeLinearForm();
  EXPECT_TRUE(linear.isLinear());
  const Eigen::MatrixXd responses = Eigen::MatrixXd::Random(layout.getRowCount(), 3);
  const Eigen::MatrixXd found = extractor.convertToLinearForm(extractor.extract(responses));
  EXPECT_LT((found - expected.extract(responses)).cwiseAbs().maxCoeff(), 1e-14);
  EXPECT_EQ(linear.extract(responses), expected.extract(responses));

  const FeatureNoise noise(extractor, Eigen::VectorXd::Constant(layout.getRowCount(), 0.1), 1);
  const FeatureNoise of_parts(expected, Eigen::VectorXd::Constant(layout.getRowCount(), 0.1), 1);
  EXPECT_FALSE(noise.isConstant());
  EXPECT_TRUE(noise.getLinearForm().isConstant());
  EXPECT_EQ(noise.getLinearForm().calcCovariance({}).toMatrix(), of_parts.calcCovariance({}).toMatrix());
  EXPECT_EQ(&of_parts.getLinearForm(), &of_parts);

  Eigen::VectorXd numbers(10);
  numbers << 1, 2, 3, 4, 5, 6, 7, 8, 9, 10;
  Eigen::VectorXd placed(12);
  placed << 1, 2, 3, 4, 5, 0, 6, 7, 0, 8, 9, 10;
  EXPECT_EQ(extractor.placeLinearForm(numbers), placed);
}

}  // namespace
}  // namespace twinmap
