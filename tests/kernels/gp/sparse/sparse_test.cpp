#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kernels/gp/fit.hpp"
#include "kernels/gp/sparse/inducing_points.hpp"
#include "kernels/gp/sparse/sparse_leave_one_out.hpp"
#include "kernels/gp/sparse/sparse_training.hpp"
#include "kernels/gp/sparse/variational_bound.hpp"
#include "tests/kernels/support/random_data.hpp"

namespace twinmap::gp {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using test::randomMatrix;

struct SparseCase {
  CovarianceFunction covariance;
  MeanFunction mean;
  int groups;
};

class Sparse : public testing::TestWithParam<SparseCase> {
 protected:
  SparseCase tested_ = GetParam();
  MatrixXd inputs_ = randomMatrix(5, 700, 1);  // two blocks
  VectorXd target_ = test::smoothTarget(inputs_, 0.2, 2).array() + 3.0;
  ModelStructure structure_{tested_.covariance, test::cyclicGroups(5, tested_.groups), false, tested_.mean};
  Hyperparameters hyperparameters_{VectorXd::LinSpaced(tested_.groups, 1.5, 2.5), 1.3, 0.15, 1.0, 1.0};
};

TEST_P(Sparse, EqualsTheExactProcessWhenEverySampleIsInducing) {
  const MatrixXd inputs = inputs_.leftCols(60), tests = randomMatrix(5, 30, 3);
  const VectorXd target = target_.head(60);
  const auto exact = fit(inputs, target, structure_, hyperparameters_);
  SparseGaussianProcessParts parts{structure_, hyperparameters_, inputs.rowwise().mean(), inputs, {}};
  ASSERT_TRUE(
      VariationalBound(inputs, target, inputs, structure_).calcPosterior(hyperparameters_, parts.posterior));
  // The jitter on K_uu, 1e-10 of s_f^2, over s_n^2 and times n.
  EXPECT_NEAR(parts.posterior.bound, exact->getNlml(), 1e-5);
  const SparseGaussianProcess sparse(parts);
  const Prediction expected = exact->predict(tests), actual = sparse.predict(tests);
  EXPECT_LT((actual.mean - expected.mean).cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_LT((actual.variance - expected.variance).cwiseAbs().maxCoeff(), 1e-6);
}

// With the same inducing inputs on the other samples.
TEST_P(Sparse, EveryGroupLeftOutEqualsAProcessWithoutIt) {
  const int n = 300, draws = 3;  // two blocks
  const MatrixXd inputs = inputs_.leftCols(n), inducing = inputs_.middleCols(600, 12);
  const auto summarize = [&](const MatrixXd& x, const VectorXd& y) {
    SparseGaussianProcessParts parts{structure_, hyperparameters_, x.rowwise().mean(), inducing, {}};
    EXPECT_TRUE(
        VariationalBound(x, y, inducing, structure_).calcPosterior(hyperparameters_, parts.posterior));
    return SparseGaussianProcess(parts);
  };
  const VectorXd target = target_.head(n);
  const SampleGroups groups = makeDrawGroups(n, draws);
  const LeaveOneOut result = calcLeaveGroupsOut(summarize(inputs, target), inputs, target, groups);
  for (const std::vector<Eigen::Index>& left : groups) {
    std::vector<Eigen::Index> kept;
    for (int i = 0; i < n; ++i) {
      if (std::find(left.begin(), left.end(), i) == left.end()) {
        kept.push_back(i);
      }
    }
    const Prediction prediction =
        summarize(inputs(Eigen::all, kept), target(kept)).predict(inputs(Eigen::all, left));
    EXPECT_LT((result.residual(left) - (target(left) - prediction.mean)).cwiseAbs().maxCoeff(), 1e-8);
    EXPECT_LT((result.stddev(left) - prediction.stddev()).cwiseAbs().maxCoeff(), 1e-8);
  }
}

TEST_P(Sparse, TheBoundLiesAboveTheExactLikelihoodAndFallsWithMoreInducingPoints) {
  const double exact = fit(inputs_, target_, structure_, hyperparameters_)->getNlml();
  double previous = std::numeric_limits<double>::infinity();
  for (int m : {5, 20, 80, 320}) {
    const MatrixXd inducing = chooseInducingPoints(inputs_, structure_, hyperparameters_, m);
    VariationalPosterior posterior;
    ASSERT_TRUE(
        VariationalBound(inputs_, target_, inducing, structure_).calcPosterior(hyperparameters_, posterior));
    EXPECT_GT(posterior.bound, exact - 1e-4);
    EXPECT_LT(posterior.bound, previous);
    previous = posterior.bound;
  }
}

TEST_P(Sparse, TheGradientEqualsFiniteDifferences) {
  const MatrixXd inducing = chooseInducingPoints(inputs_, structure_, hyperparameters_, 25);
  const VariationalBound bound(inputs_, target_, inducing, structure_);
  const VectorXd point = toLog(structure_, hyperparameters_);
  VectorXd gradient(point.size()), ignored(point.size());
  const LikelihoodEvaluation evaluation = bound.evaluate(hyperparameters_, gradient);
  ASSERT_TRUE(evaluation.ok);
  constexpr double kStep = 2e-3;
  const HyperparameterLayout layout(structure_);
  for (int i = 0; i < point.size(); ++i) {
    if (i == layout.shape) {
      continue;
    }
    const auto at = [&](double offset) {
      VectorXd moved = point;
      moved(i) += offset * kStep;
      return bound.evaluate(fromLog(structure_, moved), ignored).nlml;
    };
    const double expected = (8.0 * (at(1) - at(-1)) - (at(2) - at(-2))) / (12.0 * kStep);
    EXPECT_NEAR(gradient(i), expected, 1e-6 * std::max(1.0, std::abs(expected))) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Structures, Sparse,
    testing::Values(SparseCase{CovarianceFunction::kSquaredExponential, MeanFunction::kConstant, 1},
                    SparseCase{CovarianceFunction::kSquaredExponential, MeanFunction::kZero, 5},
                    SparseCase{CovarianceFunction::kMatern52, MeanFunction::kLinear, 2},
                    SparseCase{CovarianceFunction::kMatern32, MeanFunction::kConstant, 5},
                    SparseCase{CovarianceFunction::kRationalQuadratic, MeanFunction::kConstant, 1}));

TEST(SparseTraining, PredictsAsWellAsTheExactProcessAndTheSameForAnyNumberOfThreads) {
  const MatrixXd inputs = randomMatrix(3, 1500, 4), tests = randomMatrix(3, 200, 5);
  MatrixXd targets(2, 1500);
  targets.row(0) = test::smoothTarget(inputs, 0.1, 6).transpose();
  targets.row(1) = test::smoothTarget(2.0 * inputs, 0.3, 7).transpose();
  TrainingOptions options;
  options.starts = 2;
  SparseOptions sparse;
  sparse.inducing = 150;
  sparse.subset = 200;
  const auto results = trainSparse(inputs, targets, {}, options, sparse);
  options.threads = 2;
  const auto again = trainSparse(inputs, targets, {}, options, sparse);
  for (int t = 0; t < 2; ++t) {
    ASSERT_TRUE(results[t].gp) << results[t].message;
    EXPECT_LE(results[t].bound, results[t].subset_bound + 1e-9);
    EXPECT_EQ(results[t].bound, again[t].bound);
    EXPECT_EQ(results[t].gp->getParts().posterior.weights, again[t].gp->getParts().posterior.weights);
    const VectorXd truth = test::smoothTarget(t == 0 ? tests : 2.0 * tests, 0.0, 1);
    const auto exact = fit(inputs, targets.row(t).transpose(), {}, results[t].gp->getHyperparameters());
    EXPECT_LT((results[t].gp->predict(tests).mean - truth).norm(),
              1.1 * (exact->predict(tests).mean - truth).norm());
  }
}

TEST(SparseTraining, DuplicateSamplesAndMoreInducingPointsThanSamplesDoNoHarm) {
  MatrixXd inputs = randomMatrix(2, 40, 8);
  inputs.rightCols(20) = inputs.leftCols(20).eval();
  const auto result = trainSparse(inputs, test::smoothTarget(inputs, 0.1, 9).transpose(), {})[0];
  ASSERT_TRUE(result.gp) << result.message;
  EXPECT_LE(result.gp->getInducingCount(), 20);
  EXPECT_TRUE(result.gp->predict(inputs).variance.allFinite());
}

TEST(SparseTraining, RefusesWhatItCannotDo) {
  const MatrixXd inputs = randomMatrix(2, 40, 8);
  const MatrixXd targets = test::smoothTarget(inputs, 0.1, 9).transpose();
  ModelStructure structure;
  structure.linear_term = true;
  EXPECT_THROW((void)trainSparse(inputs, targets, structure), std::invalid_argument);
  EXPECT_THROW((void)trainSparse(inputs, targets, {}, {}, {0, 100, 0}), std::invalid_argument);
  const auto constant = trainSparse(inputs, MatrixXd::Ones(1, 40), {});
  EXPECT_EQ(constant[0].status, TrainingStatus::kConstantTarget);
  EXPECT_FALSE(constant[0].gp);
}

}  // namespace
}  // namespace twinmap::gp
