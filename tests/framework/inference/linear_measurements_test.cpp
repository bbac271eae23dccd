// What is inferred of measurements whose response is linear in the parameters, against closed forms.
#include <gtest/gtest.h>

#include <cmath>

#include "framework/base/random/random.hpp"
#include "framework/inference/refiner.hpp"
#include "tests/framework/support/linear_simulator.hpp"
#include "tests/lu.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

constexpr int kSamples = 60;
constexpr double kStddev = 0.1;
const Vector2d kTruth(1.5, -2.0);

MatrixXd makeMatrix() {
  MatrixXd matrix(kSamples, 2);
  for (Index i = 0; i < kSamples; ++i) {
    matrix.row(i) << std::sin(0.3 * static_cast<double>(i)), std::cos(0.5 * static_cast<double>(i));
  }
  return matrix;
}

VectorXd drawNoise(double stddev) {
  const RandomStream random(3, RandomPurpose::kTestNoise);
  return VectorXd::NullaryExpr(
      kSamples, [&](Index i) { return stddev * random.calcNormal(0, static_cast<std::uint64_t>(i)); });
}

/// Bounds of 20 are hundreds of standard deviations wide.
ExperimentSpec makeExperiment(const testing::LinearSimulator& simulator) {
  ExperimentSpec experiment;
  experiment.model.parameters = testing::makeParameters(2, -10.0, 10.0);
  experiment.model.outputs.resize(1);
  experiment.model.outputs[0].name.text = "y";
  experiment.features = testing::makeAllFeatures(simulator);
  experiment.noise.stddev = {{{"y", {}}, {kStddev}}};
  return experiment;
}

/// Weighted least squares of the rows that are there.
struct ClosedForm {
  VectorXd mean, stddev;
  double chi_square = 0.0;
};

ClosedForm solve(const MatrixXd& matrix, const VectorXd& measured, double stddev = kStddev) {
  MatrixXd rows = matrix;
  VectorXd values = measured;
  for (Index i = 0; i < values.size(); ++i) {
    if (std::isnan(values[i])) {
      rows.row(i).setZero();
      values[i] = 0.0;
    }
  }
  const MatrixXd inverse = test::calcInverse(rows.transpose() * rows);
  const VectorXd mean = inverse * (rows.transpose() * values);
  return {mean, stddev * inverse.diagonal().cwiseSqrt(),
          (values - rows * mean).squaredNorm() / (stddev * stddev)};
}

class LinearMeasurement : public ::testing::Test {
 protected:
  PosteriorEstimate sample(const VectorXd& measured, const ExperimentSpec& experiment) const {
    const SimulatorRefiner sampler = makeSampler(experiment);
    return sampler
        .samplePosterior(measured, VectorXd(0), sampler.describeNoise({}), MatrixXd(2, 0),
                         makePosteriorOptions(experiment, 2000))
        .estimate;
  }

  PosteriorEstimate sample(const VectorXd& measured) const { return sample(measured, experiment_); }

  SimulatorRefiner makeSampler(const ExperimentSpec& experiment) const {
    return {experiment, simulator_.getLayout(), simulator_.clone()};
  }

  /// Draws of weights that differ are worth fewer: 4 standard errors of their mean, and of their spread.
  static void expectClosedForm(const PosteriorEstimate& found, const ClosedForm& expected) {
    ASSERT_TRUE(found.isReliable()) << found.message;
    const double error = 4.0 / std::sqrt(found.effective_sample_size);
    for (Index j = 0; j < 2; ++j) {
      EXPECT_NEAR(found.estimate.mean[j], expected.mean[j], error * expected.stddev[j]);
      EXPECT_NEAR(found.estimate.stddev[j] / expected.stddev[j], 1.0, error);
    }
  }

  testing::LinearSimulator simulator_{makeMatrix()};
  ExperimentSpec experiment_ = makeExperiment(simulator_);
  VectorXd measured_ = makeMatrix() * kTruth + drawNoise(kStddev);
};

TEST_F(LinearMeasurement, HasTheClosedFormAsItsPosterior) {
  const PosteriorEstimate found = sample(measured_);
  const ClosedForm expected = solve(makeMatrix(), measured_);
  expectClosedForm(found, expected);
  ASSERT_TRUE(found.fit.has_value());
  EXPECT_NEAR(found.fit->chi_square, expected.chi_square, 1e-6 * expected.chi_square);
  EXPECT_TRUE(found.fit->isPlausible());
  EXPECT_TRUE(found.fit->isAsStated());
  EXPECT_TRUE(found.fit->outliers.empty());
}

TEST_F(LinearMeasurement, LeavesOutWhatIsMissing) {
  measured_.segment(10, 5).setConstant(std::nan(""));
  measured_[40] = std::nan("");
  const PosteriorEstimate found = sample(measured_);
  const ClosedForm expected = solve(makeMatrix(), measured_);
  expectClosedForm(found, expected);
  EXPECT_EQ(found.fit->residual.size(), kSamples - 6);
  EXPECT_NEAR(found.fit->chi_square, expected.chi_square, 1e-6 * expected.chi_square);
}

TEST_F(LinearMeasurement, TakesNoNoticeOfASpikeThatItNames) {
  measured_[17] += 2.0;
  const PosteriorEstimate found = sample(measured_);
  ASSERT_EQ(found.fit->outliers.size(), 1U);
  EXPECT_NE(found.fit->outliers[0].find("y(18 s)"), std::string::npos) << found.fit->outliers[0];
  measured_[17] = std::nan("");
  expectClosedForm(found, solve(makeMatrix(), measured_));
}

TEST_F(LinearMeasurement, FindsNoiseOfAnotherSize) {
  measured_ = makeMatrix() * kTruth + drawNoise(3.0 * kStddev);
  const PosteriorEstimate found = sample(measured_);
  ASSERT_EQ(found.fit->noise.size(), 1U);
  EXPECT_EQ(found.fit->noise[0].output, "y");
  EXPECT_TRUE(found.fit->noise[0].differs());
  const ClosedForm expected = solve(makeMatrix(), measured_);
  const double size = std::sqrt(expected.chi_square / (kSamples - 2));  // of the residual, over that stated
  EXPECT_NEAR(found.fit->getNoiseFactor(), size, 0.1 * size);  // 1 / sqrt(2 * 58), what a size is known to
  EXPECT_NEAR(found.fit->noise[0].stddev, kStddev * found.fit->getNoiseFactor(), 1e-12);
}

TEST_F(LinearMeasurement, IntegratesOverASizeThatIsUnknown) {
  NoiseStddev unknown(1.0);
  unknown.unknown = true;
  experiment_.noise.stddev[0].stddev = unknown;
  const PosteriorEstimate found = sample(measured_, experiment_);
  const double size = std::sqrt(solve(makeMatrix(), measured_, 1.0).chi_square / (kSamples - 2));
  ASSERT_TRUE(found.isReliable()) << found.message;
  ASSERT_EQ(found.fit->noise.size(), 1U);
  EXPECT_FALSE(found.fit->noise[0].isStated());
  EXPECT_NEAR(found.fit->noise[0].stddev, size, 0.1 * size);
  // Student's t of 58 degrees of freedom is wider than normal by 1 / (1 - 2 / 58) in variance
  const ClosedForm expected = solve(makeMatrix(), measured_, size * std::sqrt(58.0 / 56.0));
  expectClosedForm(found, expected);
}

TEST_F(LinearMeasurement, FindsTheOffsetOfASensor) {
  measured_.array() += 0.4;
  const PosteriorEstimate found = sample(measured_);
  ASSERT_TRUE(found.fit->hasOffset());
  MatrixXd with(kSamples, 3);
  with << makeMatrix(), VectorXd::Ones(kSamples);
  const ClosedForm expected = solve(with, measured_);
  expectClosedForm(found, expected);
  EXPECT_NEAR(found.fit->noise[0].found.offset, expected.mean[2], 0.1 * expected.stddev[2]);
  EXPECT_NEAR(found.fit->noise[0].found.offset_stddev, expected.stddev[2], 0.1 * expected.stddev[2]);
}

TEST_F(LinearMeasurement, SaysThatNothingExplainsWhatTheModelLacks) {
  for (Index i = 0; i < kSamples; ++i) {
    measured_[i] += 2.0 * std::sin(0.1 * static_cast<double>(i));  // slow, and orthogonal to neither column
  }
  const PosteriorEstimate found = sample(measured_);
  EXPECT_FALSE(found.fit->isPlausible());
  EXPECT_TRUE(found.fit->isAsStated());  // coloured and larger than stated may as well be physics
  EXPECT_NEAR(found.fit->chi_square, solve(makeMatrix(), measured_).chi_square, 1e-3);
}

TEST_F(LinearMeasurement, HasALeastChiSquareInProportionToWhatIsThere) {
  const SimulatorRefiner sampler = makeSampler(experiment_);
  const double all = solve(makeMatrix(), measured_).chi_square;
  EXPECT_NEAR(sampler.findLeastChiSquare(measured_, VectorXd(0), kSamples), all, 1e-6 * all);
  measured_.tail(20).setConstant(std::nan(""));
  const double some = 1.5 * solve(makeMatrix(), measured_).chi_square;  // 60 of 40
  EXPECT_NEAR(sampler.findLeastChiSquare(measured_, VectorXd(0), kSamples), some, 1e-6 * some);
  measured_.tail(30).setConstant(std::nan(""));
  EXPECT_TRUE(std::isinf(sampler.findLeastChiSquare(measured_, VectorXd(0), kSamples)));
}

TEST_F(LinearMeasurement, FitsNuisanceParametersAloneWhereTheOthersAreHeld) {
  experiment_.model.nuisance = {experiment_.model.parameters[1]};
  experiment_.model.parameters.pop_back();
  const Refined found = makeSampler(experiment_).fitNuisance(Vector2d(kTruth[0] + 0.05, 7.0), measured_);
  const VectorXd column = makeMatrix().col(1);
  const double expected =
      column.dot(measured_ - makeMatrix().col(0) * (kTruth[0] + 0.05)) / column.squaredNorm();
  EXPECT_EQ(found.point[0], kTruth[0] + 0.05);
  EXPECT_NEAR(found.point[1], expected, 0.03 * kStddev / column.norm());
}

TEST_F(LinearMeasurement, NamesWhyNothingCanBeSimulated) {
  const auto say = [&](double fails_above) {
    const testing::LinearSimulator simulator(makeMatrix(), fails_above);
    return SimulatorSampler(experiment_, simulator.getLayout(), simulator.clone()).findFailure(VectorXd(0));
  };
  EXPECT_EQ(say(1e300), "");
  EXPECT_EQ(say(-5.0), "");  // not at the centre, but at one of the other points
  EXPECT_EQ(say(-11.0), "too much");
}

}  // namespace
}  // namespace twinmap
