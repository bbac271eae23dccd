#include "framework/data/sensitivity/feature_sensitivities.hpp"

#include <gtest/gtest.h>

#include "framework/models/mechanism/simulator/multibody_simulator.hpp"
#include "tests/framework/models/mechanism/two_beam.hpp"

namespace twinmap::testing {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

std::vector<FeatureSpec> makeFeatures() {
  return {SamplesFeatureSpec{{{"y", {}}, {"theta", {}}}, 0.05, 0.05, 100}};
}

VectorXd calcWidths(const ModelSpec& model) {
  VectorXd widths(model.parameters.size());
  for (Eigen::Index j = 0; j < widths.size(); ++j) {
    widths[j] = model.parameters[j].bounds.upper - model.parameters[j].bounds.lower;
  }
  return widths;
}

VectorXd calcClosedForm(const VectorXd& point) {
  const MatrixXd response = integrateTwoBeam(point, makeTwoBeamTimes());  // 2 x times
  return response.transpose().reshaped();
}

/// Differences of order 4 of the closed-form equations on fixed steps: truncation and rounding below 1e-7.
MatrixXd calcClosedFormSensitivities(const VectorXd& point, const VectorXd& widths) {
  constexpr double kStep = 1e-3;
  MatrixXd sensitivities(200, point.size());
  for (Eigen::Index j = 0; j < point.size(); ++j) {
    const VectorXd h = kStep * widths[j] * VectorXd::Unit(point.size(), j);
    sensitivities.col(j) = (8.0 * (calcClosedForm(point + h) - calcClosedForm(point - h)) -
                            (calcClosedForm(point + 2.0 * h) - calcClosedForm(point - 2.0 * h))) /
                           (12.0 * kStep);
  }
  return sensitivities;
}

double calcLargestColumnError(const MatrixXd& sensitivities, const MatrixXd& expected) {
  return ((sensitivities - expected).colwise().norm().array() / expected.colwise().norm().array()).maxCoeff();
}

class TwoBeamSensitivities : public ::testing::Test {
 protected:
  ModelSpec model_ = makeTwoBeam();
  std::vector<FeatureSpec> features_ = makeFeatures();
  MultibodySimulator simulator_{model_, collectTimes(features_)};
  FeatureExtractor extractor_{features_, simulator_.getLayout()};
};

TEST_F(TwoBeamSensitivities, AreThoseOfTheClosedFormEquations) {
  const MatrixXd points = makeTwoBeamPoints(8);
  const VectorXd widths = calcWidths(model_);
  const auto models = calcLocalModels(simulator_, extractor_, model_.parameters, points, 1);
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const LocalModel& local = models[i];
    ASSERT_TRUE(local.status.ok) << local.status.reason;
    const MatrixXd expected = calcClosedFormSensitivities(points.col(i), widths);
    for (const auto& rows : {Eigen::seqN(0, 100), Eigen::seqN(100, 100)}) {  // y and theta have other scales
      EXPECT_LT(calcLargestColumnError(local.sensitivities(rows, Eigen::all), expected(rows, Eigen::all)),
                1e-4);
    }
  }
}

TEST_F(TwoBeamSensitivities, DoNotLeaveTheBounds) {
  MatrixXd corner(4, 1);
  for (Eigen::Index j = 0; j < 4; ++j) {
    corner(j, 0) = j % 2 == 0 ? model_.parameters[j].bounds.lower : model_.parameters[j].bounds.upper;
  }
  const LocalModel local = calcLocalModels(simulator_, extractor_, model_.parameters, corner, 1).front();
  EXPECT_LT(calcLargestColumnError(local.sensitivities,
                                   calcClosedFormSensitivities(corner.col(0), calcWidths(model_))),
            1e-4);
}

TEST_F(TwoBeamSensitivities, AreTheSameForAnyNumberOfThreads) {
  const MatrixXd points = makeTwoBeamPoints(5);
  const auto expected = calcLocalModels(simulator_, extractor_, model_.parameters, points, 1);
  for (const int threads : {2, 3, 5}) {
    const auto models = calcLocalModels(simulator_, extractor_, model_.parameters, points, threads);
    for (std::size_t i = 0; i < models.size(); ++i) {
      EXPECT_EQ(models[i].sensitivities, expected[i].sensitivities);
      EXPECT_EQ(models[i].features, expected[i].features);
    }
  }
}

TEST_F(TwoBeamSensitivities, AFailedSimulationFailsThePoint) {
  model_.simulation.max_steps = 3;
  const MultibodySimulator simulator(model_, collectTimes(features_));
  const auto models = calcLocalModels(simulator, extractor_, model_.parameters, makeTwoBeamPoints(1), 1);
  EXPECT_FALSE(models[0].status.ok);
  EXPECT_NE(models[0].status.reason.find("step limit"), std::string::npos);
  EXPECT_TRUE(models[0].sensitivities.array().isNaN().all());
}

}  // namespace
}  // namespace twinmap::testing
