#include "framework/inference/select_estimate.hpp"

#include <gtest/gtest.h>

#include "framework/inference/text/inference_text.hpp"

namespace twinmap {
namespace {

/// The map is twice above what the measurement allows for k, at the limit for c.
InferredMeasurement makeInferred() {
  InferredMeasurement inferred;
  inferred.by_estimator.mean = Eigen::Vector2d(1.0, 2.0);
  inferred.by_estimator.stddev = Eigen::Vector2d(0.2, 0.1);
  inferred.by_estimator.limit_stddev = Eigen::Vector2d(0.1, 0.1);
  inferred.by_estimator.correlation = (Eigen::Matrix2d() << 1.0, 0.5, 0.5, 1.0).finished();
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
  refined.mean = refined.point;
  refined.stddev = Eigen::Vector2d(0.1, 0.1);
  refined.covariance = (Eigen::Matrix2d() << 0.01, -0.002, -0.002, 0.01).finished();
  return refined;
}

using Statuses = std::vector<std::string>;

TEST(SelectEstimate, HasTheIntervalsThatTheEstimatorSays) {
  InferredMeasurement inferred = makeInferred();
  const Bounds95 normal = selectEstimate(inferred).calcBounds95();
  EXPECT_DOUBLE_EQ(normal.lower[0], 1.0 - kNormal95 * 0.2);
  EXPECT_DOUBLE_EQ(normal.upper[1], 2.0 + kNormal95 * 0.1);
  inferred.by_estimator.interval_factors = {Eigen::Vector2d(0.8, kNormal50), Eigen::Vector2d(1.6, kNormal95)};
  const Estimate estimate = selectEstimate(inferred);
  const Bounds95 bounds = estimate.calcBounds95();
  EXPECT_DOUBLE_EQ(bounds.lower[0], 1.0 - 1.6 * 0.2);
  EXPECT_DOUBLE_EQ(bounds.upper[0], 1.0 + 1.6 * 0.2);
  EXPECT_EQ(bounds.upper[1], normal.upper[1]);
  EXPECT_DOUBLE_EQ(estimate.findIntervals(0, Coverage::k50).front().second, 1.0 + 0.8 * 0.2);
  inferred.refined = makeRefined(RefinementStatus::kAccepted);
  EXPECT_DOUBLE_EQ(selectEstimate(inferred).calcBounds95().lower[0], 1.0 - kNormal95 * 0.1);
}

TEST(SelectEstimate, OfAMixtureHasItsSmallestSets) {
  InferredMeasurement inferred = makeInferred();
  inferred.by_estimator.mixture = {Eigen::VectorXd::Ones(1),
                                   inferred.by_estimator.mean,
                                   inferred.by_estimator.stddev,
                                   {Eigen::MatrixXd::Identity(2, 2)}};
  inferred.by_estimator.interval_factors = {Eigen::Vector2d(0.8, kNormal50), Eigen::Vector2d(1.6, kNormal95)};
  const Estimate estimate = selectEstimate(inferred);
  EXPECT_NEAR(estimate.calcBounds95().lower[0], 1.0 - 1.6 * 0.2, 1e-9);
  EXPECT_NEAR(estimate.findIntervals(0, Coverage::k50).front().second, 1.0 + 0.8 * 0.2, 1e-9);
}

TEST(SelectEstimate, SaysWhatMadeItAndItsCovariance) {
  InferredMeasurement inferred = makeInferred();
  inferred.by_estimator.estimator = "surrogate";
  EXPECT_STREQ(selectEstimate(inferred).getMethod(), "surrogate");
  EXPECT_NEAR(selectEstimate(inferred).calcCovariance()(0, 1), 0.5 * 0.2 * 0.1, 1e-15);
  inferred.refined = makeRefined(RefinementStatus::kAccepted);
  const Estimate refined = selectEstimate(inferred);
  EXPECT_EQ(refined.method, EstimationMethod::kRefined);
  EXPECT_TRUE(refined.calcCovariance().isApprox(inferred.refined->covariance, 1e-14));
  EXPECT_EQ(refined.statuses, Statuses{"ok"});
}

TEST(SelectEstimate, OfAMapFarAboveWhatTheMeasurementAllowsIsEstimatorLimited) {
  const InferredMeasurement inferred = makeInferred();
  EXPECT_EQ(listStatuses(inferred), Statuses{"estimator_limited"});
  EXPECT_EQ(describeMapLimit(inferred, makeParameters()),
            "  estimator_limited: the sd of k is 2 times larger than the data would permit\n"
            "    Refine the estimate: --refine.\n");
}

TEST(SelectEstimate, OfAMapNearTheLimitIsOk) {
  InferredMeasurement inferred = makeInferred();
  inferred.by_estimator.limit_stddev = Eigen::Vector2d(0.15, 0.1);
  EXPECT_EQ(listStatuses(inferred), Statuses{"ok"});
  EXPECT_EQ(describeMapLimit(inferred, makeParameters()), "");
}

TEST(SelectEstimate, OfAMapWhoseLimitNobodyKnowsIsOk) {
  InferredMeasurement inferred = makeInferred();
  inferred.by_estimator.limit_stddev.resize(0);
  EXPECT_EQ(listStatuses(inferred), Statuses{"ok"});
}

TEST(SelectEstimate, OfAMapThatDoesNotKnowItsErrorsIsEstimatorLimitedWhateverItsDeviation) {
  InferredMeasurement inferred = makeInferred();
  inferred.by_estimator.stddev = inferred.by_estimator.limit_stddev;
  inferred.estimator_is_calibrated = false;
  EXPECT_EQ(listStatuses(inferred), Statuses{"estimator_limited"});
}

TEST(SelectEstimate, RefinedIsNotLimitedByTheMap) {
  InferredMeasurement inferred = makeInferred();
  inferred.refined = makeRefined(RefinementStatus::kAccepted);
  EXPECT_EQ(listStatuses(inferred), Statuses{"ok"});
}

TEST(SelectEstimate, NotRefinedIsTheMapsWithAllItsLimits) {
  InferredMeasurement inferred = makeInferred();
  inferred.trust->statuses = {TrustStatus::kAtBounds};
  inferred.refined = makeRefined(RefinementStatus::kMisfit);
  EXPECT_EQ(listStatuses(inferred), (Statuses{"at_bounds", "not_refined", "estimator_limited"}));
  EXPECT_EQ(describeMapLimit(inferred, makeParameters()),
            "  estimator_limited: the sd of k is 2 times larger than the data would permit\n");
}

/// Two draws as good as each other, at 2 and 4 of the first parameter.
PosteriorEstimate makeSimulated() {
  PosteriorEstimate posterior;
  posterior.source = PosteriorSource::kSimulator;
  posterior.fit = SimulatorFit{};
  posterior.fit->degrees = 10.0;
  posterior.fit->test.largest = 0;
  Estimate& estimate = posterior.estimate;
  estimate.mean = Eigen::Vector2d(3.0, 5.0);
  estimate.stddev = Eigen::Vector2d(1.0, 0.1);
  estimate.correlation = Eigen::Matrix2d::Identity();
  estimate.method = EstimationMethod::kPosterior;
  estimate.draws = {(Eigen::Matrix2d() << 2.0, 4.0, 4.9, 5.1).finished(), Eigen::Vector2d(0.5, 0.5),
                    Eigen::Vector2d(0.0, 0.0), Eigen::Vector2d(10.0, 10.0)};
  return posterior;
}

TEST(SelectEstimate, SaysThatItLiesAtBoundsWhateverIsSaidBeside) {
  InferredMeasurement inferred;
  inferred.posterior = makeSimulated();
  inferred.posterior->fit->beyond = {"offset"};  // a nuisance
  inferred.posterior->fit->test.chi_square_p = 0.0;
  inferred.posterior->fit->residual = Eigen::VectorXd::Constant(10, 30.0);
  inferred.posterior->fit->chi_square = 9000.0;
  EXPECT_EQ(listStatuses(inferred), (Statuses{"model_mismatch", "at_bounds"}));
  const std::string text = describeTrust(inferred, makeParameters(), {});
  EXPECT_NE(text.find("  at_bounds: offset lies at its bounds\n"), std::string::npos) << text;
  EXPECT_EQ(text.find("Widen"), std::string::npos) << text;
  inferred.posterior->message = "few draws carry the weight";
  EXPECT_EQ(listStatuses(inferred), (Statuses{"model_mismatch", "at_bounds", "unreliable"}));
}

TEST(SelectEstimate, SaysFirstThatAllParametersLieAtTheirBounds) {
  InferredMeasurement inferred;
  inferred.posterior = makeSimulated();
  SimulatorFit& fit = *inferred.posterior->fit;
  fit.beyond = {"k", "c"};
  fit.test.chi_square_p = 0.0;
  fit.residual = Eigen::Vector2d(850.0, -3.0);
  fit.largest_feature = "x(0.5 s)";
  const std::string text = describeTrust(inferred, makeParameters(), {});
  const std::size_t first = text.find("the best fit lies at the bounds of all parameters: ");
  const std::size_t second = text.find("  at_bounds: k, c lies at its bounds\n    Widen the bounds of k, c");
  EXPECT_TRUE(first < second && second != std::string::npos) << text;
}

TEST(SelectEstimate, TakesThePosteriorOfTheSimulatorBeforeWhatLeastSquaresFound) {
  InferredMeasurement inferred = makeInferred();
  inferred.refined = makeRefined(RefinementStatus::kAccepted);
  inferred.posterior = makeSimulated();
  inferred.coverage_is_short = true;
  inferred.trust->statuses = {
      TrustStatus::kOutsideTraining};  // of the training, which the simulator needs not
  const Estimate estimate = selectEstimate(inferred);
  EXPECT_EQ(estimate.method, EstimationMethod::kPosterior);
  EXPECT_EQ(estimate.mean[0], 3.0);
  EXPECT_EQ(estimate.statuses, Statuses{"ok"});
  inferred.trust->statuses = {TrustStatus::kModelMismatch};
  EXPECT_EQ(listStatuses(inferred), Statuses{"model_mismatch"});
}

TEST(SelectEstimate, OfSeparateModesIsMultimodal) {
  InferredMeasurement inferred;
  inferred.posterior = makeSimulated();
  EXPECT_EQ(listStatuses(inferred), Statuses{"ok"});
  inferred.posterior->shape = PosteriorShape::kMultimodal;
  EXPECT_EQ(listStatuses(inferred), Statuses{"multimodal"});
}

TEST(SelectEstimate, IsUninformativeWhereThePosteriorIsAsWideAsThePrior) {
  InferredMeasurement inferred;
  inferred.posterior = makeSimulated();
  inferred.posterior->shape = PosteriorShape::kUninformative;
  EXPECT_EQ(listStatuses(inferred), Statuses{"uninformative"});
}

TEST(SelectEstimate, WithoutAReliablePosteriorIsNeverOk) {
  InferredMeasurement inferred = makeInferred();
  inferred.refined = makeRefined(RefinementStatus::kAccepted);
  inferred.posterior = makeSimulated();
  inferred.posterior->message = "too few draws bear the weight";
  EXPECT_EQ(selectEstimate(inferred).method, EstimationMethod::kRefined);
  EXPECT_EQ(listStatuses(inferred), Statuses{"unreliable"});
  inferred.by_estimator = {};
  inferred.refined.reset();
  inferred.trust.reset();
  EXPECT_FALSE(selectEstimate(inferred).isGiven());
  EXPECT_EQ(listStatuses(inferred), Statuses{"unreliable"});
  inferred.posterior->fit = SimulatorFit{};
  EXPECT_EQ(listStatuses(inferred), Statuses{"not_simulated"});
}

TEST(SelectEstimate, OfAnEstimatorWhoseIntervalsHeldTooLittleIsUncalibratedUnlessItIsRefined) {
  InferredMeasurement inferred = makeInferred();
  inferred.by_estimator.stddev = inferred.by_estimator.limit_stddev;
  inferred.estimator_coverage_is_short = true;
  EXPECT_EQ(listStatuses(inferred), Statuses{"uncalibrated"});
  inferred.refined = makeRefined(RefinementStatus::kAccepted);
  EXPECT_EQ(listStatuses(inferred), Statuses{"ok"});
}

TEST(SelectEstimate, OfARunWhoseIntervalsHeldTooLittleIsUncalibrated) {
  InferredMeasurement inferred = makeInferred();
  inferred.refined = makeRefined(RefinementStatus::kAccepted);
  inferred.coverage_is_short = true;
  EXPECT_EQ(listStatuses(inferred), Statuses{"uncalibrated"});
}

TEST(SelectEstimate, BesideASurrogatesPosteriorInDoubtIsNotOk) {
  InferredMeasurement inferred = makeInferred();
  inferred.refined = makeRefined(RefinementStatus::kAccepted);
  inferred.posterior = PosteriorEstimate{};
  EXPECT_EQ(listStatuses(inferred), Statuses{"ok"});
  inferred.posterior->doubt = "its ranks are uneven";
  EXPECT_EQ(listStatuses(inferred), Statuses{"posterior_uncalibrated"});
  EXPECT_STREQ(inferred.posterior->getStatus(), "posterior_uncalibrated");
  inferred.posterior->message = "too few draws bear the weight";
  EXPECT_STREQ(inferred.posterior->getStatus(), "unreliable");
  EXPECT_EQ(listStatuses(inferred), Statuses{"ok"});
}

}  // namespace
}  // namespace twinmap
