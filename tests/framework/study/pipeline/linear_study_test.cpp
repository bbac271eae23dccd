// Stages of a study whose response is linear in the parameters, against closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "framework/base/log/notice.hpp"
#include "framework/base/random/random.hpp"
#include "framework/estimation/interval_factor.hpp"
#include "framework/study/pipeline/baselines.hpp"
#include "framework/study/pipeline/calibrate_posteriors.hpp"
#include "framework/study/pipeline/shared_error.hpp"
#include "kernels/linalg/decompositions.hpp"
#include "tests/framework/support/linear_simulator.hpp"
#include "tests/lu.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kNoiseStddev = 0.2;
constexpr Index kRows = 25, kTests = 200;

MatrixXd makeRows() {
  MatrixXd rows(kRows, 2);
  for (Index i = 0; i < kRows; ++i) {
    rows.row(i) << std::sin(0.4 * static_cast<double>(i)), 1.0 - 0.05 * static_cast<double>(i);
  }
  return rows;
}

/// Points well within the bounds, with measurements of them.
LabelledFeatures makeSamples(Index count, std::uint64_t seed, double noise_stddev) {
  const RandomStream random(seed, RandomPurpose::kTestNoise);
  const auto draw = [&](Index row, Index column, int kind) {
    return random.calcNormal(static_cast<std::uint64_t>(column), static_cast<std::uint64_t>(row), kind);
  };
  LabelledFeatures samples;
  samples.parameters =
      MatrixXd::NullaryExpr(2, count, [&](Index i, Index j) { return 2.0 * std::tanh(draw(i, j, 0)); });
  samples.features =
      makeRows() * samples.parameters +
      noise_stddev * MatrixXd::NullaryExpr(kRows, count, [&](Index i, Index j) { return draw(i, j, 1); });
  samples.infos.resize(static_cast<std::size_t>(kRows));
  samples.noise_covariance = MatrixXd(kNoiseStddev * kNoiseStddev * MatrixXd::Identity(kRows, kRows));
  return samples;
}

class LinearStudy : public ::testing::Test {
 protected:
  LinearStudy() {
    experiment_.model.parameters = testing::makeParameters(2, -10.0, 10.0);
    sets_.test = makeSamples(kTests, 5, kNoiseStddev);
  }

  /// The least squares of all test samples (2 x n).
  MatrixXd solveAll() const { return calcInverse() * makeRows().transpose() * sets_.test.features; }
  static MatrixXd calcInverse() { return test::calcInverse(makeRows().transpose() * makeRows()); }

  /// Exact posteriors by equal draws, `spread` times as wide as they are.
  std::vector<SimulatorPosterior> drawExactly(double spread) const {
    const MatrixXd means = solveAll(), covariance = kNoiseStddev * kNoiseStddev * calcInverse();
    const MatrixXd root = linalg::calcCholesky(covariance).lower;
    constexpr Index kExactDraws = 400;
    std::vector<SimulatorPosterior> posteriors;
    for (Index i = 0; i < means.cols(); ++i) {
      const RandomStream random(static_cast<std::uint64_t>(i), RandomPurpose::kVerification);
      const MatrixXd normal = MatrixXd::NullaryExpr(2, kExactDraws, [&](Index row, Index column) {
        return random.calcNormal(static_cast<std::uint64_t>(column), static_cast<std::uint64_t>(row));
      });
      SimulatorPosterior posterior;
      posterior.draws = (spread * root * normal).colwise() + means.col(i);
      posterior.weights = VectorXd::Constant(kExactDraws, 1.0 / kExactDraws);
      posterior.best = means.col(i);
      posterior.information = 100.0 * test::calcInverse(covariance);  // per half-width of the bounds
      posteriors.push_back(std::move(posterior));
    }
    return posteriors;
  }

  BaselineResult run(const BaselineSpec& spec) {
    RunControl control;
    control.threads = 2;
    const Study study{experiment_, simulator_, extractor_, noise_, nullptr, "", control};
    return runBaseline(spec, study, sets_, fitTransform({{ZScoreSpec{}, {}}}, sets_.train));
  }

  CalibratedPosteriors calibrate(const std::vector<SimulatorPosterior>& posteriors) {
    const Study study{experiment_, simulator_, extractor_, noise_, nullptr, "", {}};
    return calibratePosteriors(study, sets_.test, posteriors);
  }

  testing::LinearSimulator simulator_{makeRows()};
  FeatureExtractor extractor_{testing::makeAllFeatures(simulator_), simulator_.getLayout()};
  FeatureNoise noise_{extractor_, VectorXd::Constant(kRows, kNoiseStddev), 1};
  ExperimentSpec experiment_;
  LabelledSets sets_{makeSamples(300, 4, 0.0), {}};
};

TEST_F(LinearStudy, LeastSquaresAreTheClosedForm) {
  const BaselineResult found = run(LeastSquaresSpec{});
  EXPECT_EQ(found.method, "least_squares");
  ASSERT_EQ(found.samples, 50);
  EXPECT_EQ(found.unconverged, 0);
  // the bounds, 20 wide, are a normal prior of the uniform distribution's variance
  constexpr double kBoxVariance = 20.0 * 20.0 / 12.0;
  const MatrixXd covariance =
      test::calcInverse(makeRows().transpose() * makeRows() / (kNoiseStddev * kNoiseStddev) +
                        MatrixXd::Identity(2, 2) / kBoxVariance);
  const VectorXd stddev = covariance.diagonal().cwiseSqrt();
  const MatrixXd expected =
      covariance / (kNoiseStddev * kNoiseStddev) * makeRows().transpose() * sets_.test.features.leftCols(50);
  EXPECT_LT(((found.predictions.mean - expected).array().colwise() / stddev.array()).abs().maxCoeff(), 0.01);
  EXPECT_LT(((found.predictions.stddev.array().colwise() / stddev.array()) - 1.0).abs().maxCoeff(), 1e-6);
}

TEST_F(LinearStudy, LeastSquaresCountWhatDidNotConverge) {
  LeastSquaresSpec few;
  few.samples = 6;
  few.max_simulations = 3;  // not one iteration
  const BaselineResult found = run(few);
  EXPECT_EQ(found.unconverged, 6);
  EXPECT_TRUE(found.predictions.mean.allFinite());
}

TEST_F(LinearStudy, LeastSquaresBeginWhereTheFeaturesAreNearest) {
  LeastSquaresSpec spec;
  spec.start = LeastSquaresStart::kNearestTraining;
  spec.samples = 10;
  const BaselineResult found = run(spec);
  ASSERT_EQ(found.samples, 10);
  const VectorXd stddev = kNoiseStddev * calcInverse().diagonal().cwiseSqrt();
  const MatrixXd expected = solveAll().leftCols(10);
  EXPECT_LT(((found.predictions.mean - expected).array().colwise() / stddev.array()).abs().maxCoeff(), 0.05);
}

TEST_F(LinearStudy, ALinearRegressionOfWhatHasNoNoiseInvertsTheResponse) {
  sets_.test = makeSamples(kTests, 5, 0.0);
  const BaselineResult found = run(LinearRegressionSpec{});
  EXPECT_EQ(found.samples, kTests);
  EXPECT_LT((found.predictions.mean - sets_.test.parameters).cwiseAbs().maxCoeff(), 1e-8);
}

TEST_F(LinearStudy, ThePriorKnowsTheBoundsAlone) {
  experiment_.model.parameters[0].bounds = {1.0, 4.0, {}};
  const BaselineResult found = run(PriorMeanSpec{});
  EXPECT_NEAR(found.predictions.mean(0, 7), 2.5, 1e-12);
  EXPECT_NEAR(found.predictions.stddev(0, 7), 3.0 / std::sqrt(12.0), 1e-12);
  EXPECT_NEAR(found.predictions.mean(1, 0), 0.0, 1e-12);
}

TEST_F(LinearStudy, ExactPosteriorsAreCalibrated) {
  const CalibratedPosteriors found = calibrate(drawExactly(1.0));
  ASSERT_TRUE(found.calibration.has_value());
  EXPECT_EQ(found.calibration->measurements, kTests);
  EXPECT_EQ(found.calibration->ranks.p_value.size(), 3);  // of each parameter and of all together
  EXPECT_TRUE(found.notes.warnings.empty());
}

TEST_F(LinearStudy, PosteriorsThatAreTooNarrowAreNamed) {
  const CalibratedPosteriors found = calibrate(drawExactly(0.6));
  ASSERT_EQ(found.notes.warnings.size(), 1U);
  const std::string text = found.notes.warnings[0].text;
  for (const char* name : {"a (p = ", "b (p = ", "all together (p = "}) {
    EXPECT_NE(text.find(name), std::string::npos) << text;
  }
}

TEST_F(LinearStudy, PosteriorsThatAreNotReliableAreCountedAndWarnedOf) {
  std::vector<SimulatorPosterior> posteriors = drawExactly(1.0);
  for (std::size_t i = 0; i < 11; ++i) {  // 5.5 %
    posteriors[i].message = "too few draws";
  }
  CalibratedPosteriors found = calibrate(posteriors);
  ASSERT_TRUE(found.calibration.has_value());
  EXPECT_EQ(found.calibration->unreliable, 11);
  ASSERT_EQ(found.notes.warnings.size(), 1U);
  EXPECT_EQ(found.notes.warnings[0].text, makeWarning(Notice::kPosteriorsUnreliable, 11, kTests).text);
  for (std::size_t i = 0; i + kMinRanks <= posteriors.size(); ++i) {
    posteriors[i].message = "too few draws";
  }
  found = calibrate(posteriors);  // 49 are left
  EXPECT_FALSE(found.calibration.has_value());
  EXPECT_NE(found.notes.warnings.at(0).text.find("49 of 200 test samples"), std::string::npos);
}

/// A map whose errors are known, of a test set whose first sample failed.
TEST_F(LinearStudy, ErrorsThatMeasurementsShareAreThoseWithoutNoise) {
  PreparedData data;
  data.labelled = sets_;
  Trajectories& test = data.sets.test;
  test.responses = MatrixXd::Constant(kRows, kTests + 1, std::numeric_limits<double>::quiet_NaN());
  test.responses.rightCols(kTests) = makeRows() * sets_.test.parameters;
  test.statuses.assign(static_cast<std::size_t>(kTests + 1), SampleStatus{});
  test.statuses.front().ok = false;
  data.labelled.test.inputs.resize(0, kTests);
  TrainedMap map;
  map.predict = [](const MatrixXd& features, const MatrixXd&) {
    const VectorXd off = (VectorXd(2) << 0.1, -0.2).finished(),
                   stddev = (VectorXd(2) << 0.05, 0.4).finished();
    Estimates estimates;
    estimates.mean = (calcInverse() * makeRows().transpose() * features).colwise() + off;
    estimates.stddev = stddev.replicate(1, features.cols());
    return estimates;
  };
  const Study study{experiment_, simulator_, extractor_, noise_, nullptr, "", {}};
  const VectorXd shared = calcSharedError(study, data, map);
  EXPECT_NEAR(shared[0], 2.0 / kNormal95, 1e-9);
  EXPECT_NEAR(shared[1], 0.5 / kNormal95, 1e-9);
}

}  // namespace
}  // namespace twinmap
