#include "framework/study/pipeline/select_answers.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

TEST(CountSampled, AllOfFewSamples) {
  EXPECT_EQ(countSampled(0, 400, 100.0), 0u);
  EXPECT_EQ(countSampled(80, 100, 100.0), 80u);
  EXPECT_EQ(countSampled(2, 5000, 100.0), 1u);
}

// As many as make the inverse of the sum of the squared weights so many samples.
TEST(CountSampled, AsManyAsFiguresNeed) {
  EXPECT_EQ(countSampled(500, 500, 119.0), 119u);
  EXPECT_EQ(countSampled(1500, 1500, 304.0), 304u);
  for (const std::size_t needing : {60u, 150u, 300u, 399u}) {
    const auto sampled = static_cast<double>(countSampled(needing, 400, 119.0));
    const auto squares = [&](double count) {
      return static_cast<double>(needing * needing) / count + 400.0 - static_cast<double>(needing);
    };
    EXPECT_GE(400.0 * 400.0 / squares(sampled), 119.0);
    EXPECT_LT(400.0 * 400.0 / squares(sampled - 1.0), 119.0) << needing;
  }
}

Refined makeAccepted(double mean) {
  Refined refined;
  refined.status = RefinementStatus::kAccepted;
  refined.mean = refined.point = VectorXd::Constant(1, mean);
  refined.stddev = VectorXd::Constant(1, 0.1);
  refined.covariance = MatrixXd::Constant(1, 1, 0.01);
  return refined;
}

/// Draws evenly over an interval, or over it and its mirror image.
PosteriorEstimate makePosterior(double lower, double upper, bool mirrored) {
  constexpr Index kDraws = 200;
  Estimate estimate;
  estimate.draws.points = Eigen::RowVectorXd::LinSpaced(kDraws, lower, upper);
  if (mirrored) {
    const Eigen::RowVectorXd image = -estimate.draws.points;
    estimate.draws.points.conservativeResize(1, 2 * kDraws);
    estimate.draws.points.rightCols(kDraws) = image;
  }
  const Index n = estimate.draws.points.cols();
  estimate.draws.weights = VectorXd::Constant(n, 1.0 / static_cast<double>(n));
  estimate.draws.lower = VectorXd::Constant(1, -5.0);
  estimate.draws.upper = VectorXd::Constant(1, 5.0);
  const double mean = estimate.draws.points.mean();
  estimate.mean = VectorXd::Constant(1, mean);
  estimate.stddev = VectorXd::Constant(1, std::sqrt((estimate.draws.points.array() - mean).square().mean()));
  estimate.correlation = MatrixXd::Ones(1, 1);
  estimate.method = EstimationMethod::kPosterior;
  const double center = 0.5 * (lower + upper);
  if (mirrored) {
    estimate.mixture = {VectorXd::Constant(2, 0.5),
                        Eigen::RowVector2d(center, -center),
                        Eigen::RowVector2d(0.2, 0.3),
                        {MatrixXd::Ones(1, 1), MatrixXd::Ones(1, 1)}};
  }
  PosteriorEstimate posterior;
  posterior.source = PosteriorSource::kSimulator;
  posterior.estimate = std::move(estimate);
  posterior.fit.emplace();
  posterior.shape = mirrored ? PosteriorShape::kMultimodal : PosteriorShape::kInformative;
  return posterior;
}

/// Five samples: one refined, two that need a posterior for a bound alone, two for another reason; of each
/// pair the second was sampled.
InferredTests makeTests() {
  InferredTests tests;
  tests.by_estimator = {Eigen::RowVectorXd::Constant(5, 9.0), Eigen::RowVectorXd::Constant(5, 2.0)};
  for (Index i = 0; i < 5; ++i) {
    tests.refined.push_back(makeAccepted(static_cast<double>(i)));
    InferredMeasurement inferred;
    inferred.by_estimator = {VectorXd::Constant(1, 9.0), VectorXd::Constant(1, 2.0)};
    inferred.refined = tests.refined.back();
    inferred.trust.emplace();
    inferred.trust->statuses = {TrustStatus::kOk};
    tests.inferred.push_back(std::move(inferred));
  }
  tests.near = {{1, 2}, {2}};
  tests.elsewhere = {{3, 4}, {4}};
  tests.inferred[2].posterior = makePosterior(1.9, 2.1, false);
  tests.inferred[4].posterior = makePosterior(3.8, 4.2, true);
  return tests;
}

const Eigen::RowVectorXd kTruth = (Eigen::RowVectorXd(5) << 0.0, 1.0, 2.0, 3.0, -4.1).finished();

TEST(SelectAnswers, TakeThePosteriorWhereItWasSampled) {
  const InferredTests tests = makeTests();
  const Estimates answers = selectAnswers(tests, MatrixXd::Ones(1, 1), kTruth);
  EXPECT_EQ(answers.mean(0, 0), 0.0);  // refined
  EXPECT_EQ(answers.mean(0, 1), 1.0);
  EXPECT_NEAR(answers.mean(0, 2), 2.0, 1e-12);
  EXPECT_NEAR(answers.interval_factors.of95(0, 2) * answers.stddev(0, 2), 0.095, 2e-3);  // of an even one
  EXPECT_NEAR(answers.interval_factors.of50(0, 2) * answers.stddev(0, 2), 0.05, 2e-3);
  EXPECT_NEAR(answers.interval_factors.of95(0, 0), 1.96, 1e-2);
}

TEST(SelectAnswers, SeveralValuesAreJudgedByTheNearest) {
  const Estimates answers = selectAnswers(makeTests(), MatrixXd::Ones(1, 1), kTruth);
  EXPECT_NEAR(answers.mean(0, 4), -4.0, 1e-12);
  EXPECT_EQ(answers.stddev(0, 4), 0.3);
  EXPECT_EQ(answers.mixtures[4].countComponents(), 2);
  EXPECT_EQ(answers.mixtures[0].countComponents(), 1);
}

TEST(SelectAnswers, StandForThoseThatWereNotSampled) {
  const Estimates answers = selectAnswers(makeTests(), MatrixXd::Ones(1, 1), kTruth);
  ASSERT_EQ(answers.repeated, std::vector<Index>{2});
  EXPECT_EQ(answers.mean(0, 5), 2.0);  // the refined one of it
  EXPECT_EQ(answers.weights, (VectorXd(6) << 1, 1, 2, 0, 2, -1).finished());
  InferredTests all = makeTests();
  all.near.all = {2};
  all.elsewhere.all = {4};
  EXPECT_EQ(selectAnswers(all, MatrixXd::Ones(1, 1), kTruth).weights.size(), 0);
}

TEST(SelectAnswers, SummaryCountsStatuses) {
  const std::optional<AnswerSummary> summary = summarizeAnswers(makeTests());
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->weights, (VectorXd(5) << 1, 0, 2, 0, 2).finished());
  EXPECT_EQ(summary->answers[0].method, "refined");
  EXPECT_EQ(summary->answers[4].method, "posterior");
  EXPECT_TRUE(summary->answers[4].has("multimodal"));
  EXPECT_NEAR(summary->calcNotOk(), 0.4, 1e-12);
  EXPECT_FALSE(summarizeAnswers(InferredTests{}));
}

}  // namespace
}  // namespace twinmap
