#include "kernels/gp/polish.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "kernels/gp/training.hpp"
#include "kernels/linalg/decompositions.hpp"
#include "tests/kernels/support/random_data.hpp"

namespace twinmap::gp {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

SearchBox makeWideBox(Eigen::Index k) {
  return {VectorXd::Constant(k, -10.0), VectorXd::Constant(k, 10.0), VectorXd::Zero(k), VectorXd::Zero(k)};
}

MatrixXd makeBowl() {
  return (MatrixXd(2, 2) << 50.0, 20.0, 20.0, 10.0).finished();
}

/// 1/2 (x - a)' A (x - a) with a = (0.4, -0.3).
Objective makeQuadratic(const MatrixXd& a) {
  return [a](const VectorXd& point, VectorXd& gradient) {
    const VectorXd from = point - Vector2d(0.4, -0.3);
    gradient = a * from;
    return LikelihoodEvaluation{true, 0.5 * from.dot(gradient), 0.0};
  };
}

TEST(Polish, TakesOneStepToTheMinimumOfAParabola) {
  const SearchResult found =
      polish(makeQuadratic(makeBowl()), Vector2d(1.0, -1.0), makeBowl(), makeWideBox(2), {});
  EXPECT_TRUE(found.converged);
  EXPECT_EQ(found.evaluations, 2);
  EXPECT_NEAR(found.objective, 0.0, 1e-12);
}

TEST(Polish, LearnsTheCurvatureWhereThatGivenIsWrong) {
  for (const double wrong : {0.02, 30.0}) {
    const SearchResult found =
        polish(makeQuadratic(makeBowl()), Vector2d(1.0, -1.0),
               wrong * MatrixXd(makeBowl().diagonal().asDiagonal()), makeWideBox(2), {});
    EXPECT_TRUE(found.converged) << wrong;
    EXPECT_LT(found.objective, 2e-3) << wrong;
    EXPECT_LT(found.evaluations, 20) << wrong;
  }
}

// Where x_1 is held at -0.1, x_0 = 0.4 - 20 / 50 * 0.2.
TEST(Polish, FollowsTheBounds) {
  SearchBox box = makeWideBox(2);
  box.lower(1) = -0.1;
  const SearchResult found = polish(makeQuadratic(makeBowl()), Vector2d(1.0, 1.0), makeBowl(), box, {});
  EXPECT_TRUE(found.converged);
  EXPECT_EQ(found.end(1), -0.1);
  EXPECT_NEAR(found.end(0), 0.32, 0.01);
}

// A step cut at two bounds goes uphill here: what lies on them has to be held for the third.
TEST(Polish, ConvergesAtTwoBounds) {
  const MatrixXd factor = (MatrixXd(3, 3) << 1.0, 0.9, -0.4, 1.1, -0.1, 1.1, -0.9, -0.7, 0.7).finished();
  const MatrixXd bowl = 40.0 * factor * factor.transpose();
  const VectorXd bottom = (VectorXd(3) << 1.7, 1.8, -1.1).finished();
  const Objective objective = [&](const VectorXd& point, VectorXd& gradient) {
    gradient = bowl * (point - bottom);
    return LikelihoodEvaluation{true, 0.5 * (point - bottom).dot(gradient), 0.0};
  };
  SearchBox box = makeWideBox(3);
  box.upper.head(2).setZero();
  const SearchResult found = polish(objective, VectorXd::Constant(3, -1.0), bowl, box, {});
  EXPECT_TRUE(found.converged);
  EXPECT_LT(found.evaluations, 12);
  const VectorXd slope = bowl * (found.end - bottom);
  EXPECT_NEAR(slope(2), 0.0, 1.0);
}

TEST(Polish, CountsThePriorOnce) {
  SearchBox box = makeWideBox(2);
  box.prior_precision.setConstant(10.0);
  const SearchResult found = polish(makeQuadratic(makeBowl()), Vector2d(0.0, 0.0), makeBowl(), box, {});
  const MatrixXd whole = makeBowl() + 10.0 * MatrixXd::Identity(2, 2);
  const Vector2d expected = linalg::solvePositiveDefinite(whole, makeBowl() * Vector2d(0.4, -0.3));
  EXPECT_NEAR((found.end - expected).norm(), 0.0, 1e-9);
  EXPECT_NEAR(found.objective, found.nlml + 5.0 * expected.squaredNorm(), 1e-9);
}

// x^4 / 4 - x^2 / 2 curves downwards at 0.1; minima at -1 and 1.
TEST(Polish, LeavesASaddleDownhill) {
  const Objective objective = [](const VectorXd& point, VectorXd& gradient) {
    const double x = point(0);
    gradient(0) = 100.0 * (x * x * x - x);
    return LikelihoodEvaluation{true, 100.0 * (0.25 * x * x * x * x - 0.5 * x * x), 0.0};
  };
  const VectorXd start = VectorXd::Constant(1, 0.1);
  const SearchBox box = makeWideBox(1);
  const SearchResult found = polish(objective, start, calcCurvature(objective, start, box), box, {});
  EXPECT_TRUE(found.converged);
  EXPECT_NEAR(found.end(0), 1.0, 0.01);
}

TEST(Polish, BacksOffFromWhatCannotBeEvaluated) {
  const Objective quadratic = makeQuadratic(makeBowl());
  const Objective objective = [&](const VectorXd& point, VectorXd& gradient) {
    const LikelihoodEvaluation evaluation = quadratic(point, gradient);
    return point(0) < 0.35 ? LikelihoodEvaluation{false, std::numeric_limits<double>::infinity(), 0.0}
                           : evaluation;
  };
  const SearchResult found = polish(objective, Vector2d(1.0, -0.3), 0.3 * makeBowl(), makeWideBox(2), {});
  EXPECT_TRUE(std::isfinite(found.objective));
  EXPECT_LT(found.objective, 9.0);  // that of the start
}

// The gradient's own differences over another step, by another formula.
TEST(Curvature, IsTheGradientsDerivative) {
  const MatrixXd inputs = test::randomMatrix(3, 60, 2);
  const VectorXd target = test::smoothTarget(inputs, 0.2, 3);
  const TrainingSet set(inputs, {});
  LikelihoodWorkspace workspace(set);
  const Hyperparameters at{VectorXd::Constant(1, 1.3), 1.1, 0.25};
  const MatrixXd found = calcCurvature(set, target, at, makeWideBox(3), workspace);
  const VectorXd centre = toLog({}, at);
  for (int i = 0; i < 3; ++i) {
    constexpr double kStep = 1e-4;
    VectorXd above(3), below(3), point = centre;
    point(i) += kStep;
    evaluateLikelihoodGradient(set, target, fromLog({}, point), workspace, above);
    point(i) -= 2.0 * kStep;
    evaluateLikelihoodGradient(set, target, fromLog({}, point), workspace, below);
    const VectorXd expected = (above - below) / (2.0 * kStep);
    EXPECT_LT((found.col(i) - expected).norm(), 5e-3 * (1.0 + expected.norm()));
  }
}

// A search of 240 samples that begins with what 60 of them tell ends as low as one from the beginning.
TEST(WarmStart, EndsAsLowAsStartsDo) {
  const MatrixXd inputs = test::randomMatrix(4, 240, 5);
  const MatrixXd target = test::smoothTarget(inputs, 0.2, 3).transpose();
  ModelStructure structure;
  structure.length_scale_groups = oneGroupPerFeature(4);
  TrainingOptions options;
  const TrainingResult cold = train(inputs, target, structure, options)[0];
  options.curvature = true;
  const TrainingResult part = train(inputs.leftCols(60), target.leftCols(60), structure, options)[0];
  options.warm_starts = {{part.gp->getHyperparameters(), 4.0 * part.curvature}};
  const TrainingResult warm = train(inputs, target, structure, options)[0];
  EXPECT_EQ(warm.status, TrainingStatus::kConverged);
  EXPECT_LT(warm.gp->getNlml(), cold.gp->getNlml() + 0.01);
  EXPECT_LT(2 * warm.report.evaluations, cold.report.evaluations);
}

}  // namespace
}  // namespace twinmap::gp
