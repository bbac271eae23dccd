#include "framework/inference/answer.hpp"

#include <gtest/gtest.h>

#include "framework/inference/inference_text.hpp"

namespace twinmap {
namespace {

/// The map is twice above what the measurement allows for k, at the limit for c.
InferredMeasurement makeInferred() {
  InferredMeasurement inferred;
  inferred.inference.mean = Eigen::Vector2d(1.0, 2.0);
  inferred.inference.stddev = Eigen::Vector2d(0.2, 0.1);
  inferred.inference.limit_stddev = Eigen::Vector2d(0.1, 0.1);
  inferred.trust.emplace();
  inferred.trust->statuses = {TrustStatus::kOk};
  return inferred;
}

std::vector<ParameterSpec> makeParameters() {
  std::vector<ParameterSpec> parameters(2);
  parameters[0].name.text = "k";
  parameters[1].name.text = "c";
  return parameters;
}

Refined makeRefined(RefinementStatus status) {
  Refined refined;
  refined.status = status;
  refined.point = Eigen::Vector2d(1.0, 2.0);
  refined.stddev = Eigen::Vector2d(0.1, 0.1);
  return refined;
}

using Statuses = std::vector<std::string>;

TEST(Answer, HasIntervalsThatReachAsFarAsTheMapSays) {
  InferredMeasurement inferred = makeInferred();
  const Answer normal = makeMapAnswer(inferred.inference);
  EXPECT_DOUBLE_EQ(normal.lower95[0], 1.0 - kNormal95 * 0.2);
  EXPECT_DOUBLE_EQ(normal.upper95[1], 2.0 + kNormal95 * 0.1);
  inferred.inference.reach = {Eigen::Vector2d(0.8, kNormal50), Eigen::Vector2d(1.6, kNormal95)};
  const Answer answer = chooseAnswer(inferred);
  EXPECT_DOUBLE_EQ(answer.lower95[0], 1.0 - 1.6 * 0.2);
  EXPECT_DOUBLE_EQ(answer.upper95[0], 1.0 + 1.6 * 0.2);
  EXPECT_EQ(answer.upper95[1], normal.upper95[1]);
  inferred.refined = makeRefined(RefinementStatus::kAccepted);
  EXPECT_DOUBLE_EQ(chooseAnswer(inferred).lower95[0], 1.0 - kNormal95 * 0.1);
}

TEST(Answer, OfAMixtureHasTheSmallestSetsOfThatReach) {
  InferredMeasurement inferred = makeInferred();
  inferred.inference.mixture = {Eigen::VectorXd::Ones(1),
                                inferred.inference.mean,
                                inferred.inference.stddev,
                                {Eigen::MatrixXd::Identity(2, 2)}};
  inferred.inference.reach = {Eigen::Vector2d(0.8, kNormal50), Eigen::Vector2d(1.6, kNormal95)};
  const Answer answer = makeMapAnswer(inferred.inference);
  EXPECT_NEAR(answer.lower95[0], 1.0 - 1.6 * 0.2, 1e-9);
  const Intervals of50 = findWithin(takeMarginal(answer.mixture, 0), answer.reach.get(0).of50);
  EXPECT_NEAR(of50.front().second, 1.0 + 0.8 * 0.2, 1e-9);
}

TEST(Answer, OfAMapFarAboveWhatTheMeasurementAllowsIsEstimatorLimited) {
  const InferredMeasurement inferred = makeInferred();
  EXPECT_EQ(listStatuses(inferred), Statuses{"estimator_limited"});
  EXPECT_EQ(describeMapLimit(inferred, makeParameters()),
            "  k is 2 times above what the measurement allows: refine, or add simulations.\n");
}

TEST(Answer, OfAMapNearTheLimitIsOk) {
  InferredMeasurement inferred = makeInferred();
  inferred.inference.limit_stddev = Eigen::Vector2d(0.15, 0.1);
  EXPECT_EQ(listStatuses(inferred), Statuses{"ok"});
  EXPECT_EQ(describeMapLimit(inferred, makeParameters()), "");
}

TEST(Answer, OfAMapWhoseLimitNobodyKnowsIsOk) {
  InferredMeasurement inferred = makeInferred();
  inferred.inference.limit_stddev.resize(0);
  EXPECT_EQ(listStatuses(inferred), Statuses{"ok"});
}

TEST(Answer, OfAMapThatDoesNotKnowItsErrorsIsEstimatorLimitedWhateverItsDeviation) {
  InferredMeasurement inferred = makeInferred();
  inferred.inference.stddev = inferred.inference.limit_stddev;
  inferred.map_is_calibrated = false;
  EXPECT_EQ(listStatuses(inferred), Statuses{"estimator_limited"});
}

TEST(Answer, RefinedIsNotLimitedByTheMap) {
  InferredMeasurement inferred = makeInferred();
  inferred.refined = makeRefined(RefinementStatus::kAccepted);
  EXPECT_EQ(listStatuses(inferred), Statuses{"ok"});
}

TEST(Answer, NotRefinedIsTheMapsWithAllItsLimits) {
  InferredMeasurement inferred = makeInferred();
  inferred.trust->statuses = {TrustStatus::kAtBounds};
  inferred.refined = makeRefined(RefinementStatus::kMisfit);
  EXPECT_EQ(listStatuses(inferred), (Statuses{"at_bounds", "not_refined", "estimator_limited"}));
  EXPECT_EQ(describeMapLimit(inferred, makeParameters()),
            "  k is 2 times above what the measurement allows: add simulations.\n");
}

}  // namespace
}  // namespace twinmap
