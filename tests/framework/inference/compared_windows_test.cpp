#include "framework/inference/joint/compared_windows.hpp"

#include <gtest/gtest.h>

#include "framework/inference/select_estimate.hpp"
#include "framework/inference/text/inference_text.hpp"

namespace twinmap {
namespace {

using Eigen::Vector2d;

using Statuses = std::vector<std::string>;

std::vector<ParameterSpec> makeParameters() {
  std::vector<ParameterSpec> parameters(2);
  parameters[0].name.text = "k";
  parameters[1].name.text = "c";
  for (ParameterSpec& parameter : parameters) {
    parameter.bounds = {0.0, 10.0, {}};
  }
  return parameters;
}

/// k is c_k +- .01, c 1 +- .1.
InferredMeasurement makeWindow(double start, double k) {
  InferredMeasurement inferred;
  inferred.source = "swing.csv";
  inferred.start = start;
  inferred.by_estimator.mean = Vector2d(k, 1.0);
  inferred.by_estimator.stddev = Vector2d(0.01, 0.1);
  inferred.by_estimator.correlation = Eigen::Matrix2d::Identity();
  inferred.trust.emplace();
  inferred.trust->statuses = {TrustStatus::kOk};
  return inferred;
}

std::vector<InferredMeasurement> compare(std::vector<InferredMeasurement> windows) {
  compareWindows(makeParameters(), windows);
  return windows;
}

TEST(ComparedWindows, ThatAgreeSayNothingOfOthers) {
  for (const InferredMeasurement& one : compare({makeWindow(0.0, 2.0), makeWindow(10.0, 2.02)})) {
    EXPECT_EQ(listStatuses(one), Statuses{"ok"});
    EXPECT_EQ(selectEstimate(one).stddev, Vector2d(0.01, 0.1));
  }
}

TEST(ComparedWindows, ThatContradictSaySoAndHaveIntervalsThatHoldEachOther) {
  const auto windows = compare({makeWindow(0.0, 2.0), makeWindow(10.0, 2.2)});
  for (const InferredMeasurement& one : windows) {
    EXPECT_EQ(listStatuses(one), Statuses{"trials_disagree"});
    EXPECT_EQ(one.asked.starts, (std::vector<double>{0.0, 10.0}));
    const Estimate estimate = selectEstimate(one);
    EXPECT_NEAR(estimate.stddev[0], 0.2 / std::sqrt(2.0), 1e-3);
    EXPECT_NEAR(estimate.stddev[1], 0.1, 1e-12);  // c agrees
    const Bounds95 bounds = estimate.calcBounds95();
    EXPECT_LT(bounds.lower[0], 2.0);
    EXPECT_GT(bounds.upper[0], 2.2);
    EXPECT_GE(bounds.lower[0], 0.0);  // a bound
    EXPECT_NE(makeInferenceTable(one, makeParameters(), {}).find("k scatters by 14.1 of its sds"),
              std::string::npos);
  }
}

TEST(ComparedWindows, OfWhichOneMisleadsAreTheOthers) {
  std::vector<InferredMeasurement> windows{makeWindow(0.0, 2.0), makeWindow(10.0, 2.01),
                                           makeWindow(20.0, 7.0)};
  windows.back().trust->statuses = {TrustStatus::kModelMismatch};
  windows = compare(std::move(windows));
  EXPECT_EQ(listStatuses(windows[0]), Statuses{"ok"});
  EXPECT_EQ(listStatuses(windows[2]), Statuses{"model_mismatch"});
}

TEST(ComparedWindows, OfAMachineThatChangedAgreeAboutItsCourse) {
  std::vector<InferredMeasurement> windows;
  for (int i = 0; i < 12; ++i) {
    windows.push_back(makeWindow(10.0 * i, i < 6 ? 2.0 : 2.2));
  }
  for (const InferredMeasurement& one : compare(windows)) {
    EXPECT_EQ(listStatuses(one), Statuses{"ok"});
  }
  for (int i = 0; i < 12; i += 2) {
    windows[static_cast<std::size_t>(i)].by_estimator.mean[0] += 0.1;
  }
  for (const InferredMeasurement& one : compare(windows)) {
    EXPECT_EQ(listStatuses(one), Statuses{"trials_disagree"});
    EXPECT_NEAR(selectEstimate(one).stddev[0], 0.05, 0.02);  // about the step
  }
}

}  // namespace
}  // namespace twinmap
