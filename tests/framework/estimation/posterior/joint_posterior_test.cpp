#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "framework/estimation/posterior/simulator_posterior.hpp"
#include "tests/framework/estimation/refined/problem.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using testing::makeMatrix;
using testing::makeVector;
using testing::Problem;

constexpr double kNoise = 0.05;

/// y = A x + b of one unknown offset b: linear in all.
Problem makeTrial(const MatrixXd& matrix) {
  return Problem(
      static_cast<int>(matrix.rows()),
      [matrix](const VectorXd& x) -> VectorXd { return (matrix * x.head(2)).array() + x[2]; },
      testing::makeParameters(3, -1.0, 1.0), kNoise);
}

/// Two recordings of one machine, each with its offset.
PosteriorProblem join(Problem& a, Problem& b, const VectorXd& of_a, const VectorXd& of_b) {
  PosteriorProblem problem;
  problem.unknown = testing::makeParameters(4, -1.0, 1.0);
  problem.trials = {{&a.simulator, &a.model, of_a, VectorXd::Zero(3), {0, 1, 2}},
                    {&b.simulator, &b.model, of_b, VectorXd::Zero(3), {0, 1, 3}}};
  return problem;
}

/// The posterior of linear measurements with a flat prior, far from the bounds: generalised least squares.
void expectLeastSquares(const SimulatorPosterior& posterior, const MatrixXd& a, const MatrixXd& b,
                        const VectorXd& of_a, const VectorXd& of_b) {
  MatrixXd jacobian = MatrixXd::Zero(a.rows() + b.rows(), 4);
  jacobian.topLeftCorner(a.rows(), 2) = a;
  jacobian.block(0, 2, a.rows(), 1).setOnes();
  jacobian.bottomLeftCorner(b.rows(), 2) = b;
  jacobian.block(a.rows(), 3, b.rows(), 1).setOnes();
  VectorXd measured(a.rows() + b.rows());
  measured << of_a, of_b;
  const MatrixXd covariance = kNoise * kNoise * Eigen::Matrix4d(jacobian.transpose() * jacobian).inverse();
  const VectorXd mean = covariance * jacobian.transpose() * measured / (kNoise * kNoise);
  ASSERT_TRUE(posterior.isReliable()) << posterior.message;
  for (Index j = 0; j < posterior.mean.size(); ++j) {
    const double stddev = std::sqrt(covariance(j, j));
    EXPECT_NEAR(posterior.mean[j], mean[j], 0.06 * stddev);
    EXPECT_NEAR(posterior.stddev[j] / stddev, 1.0, 0.06);
  }
}

class JointPosterior : public ::testing::Test {
 protected:
  const MatrixXd matrix_a_ = makeMatrix(12, 2), matrix_b_ = 2.0 * makeMatrix(24, 2).bottomRows(12);
  Problem a_ = makeTrial(matrix_a_), b_ = makeTrial(matrix_b_);
  const VectorXd of_a_ = a_.measure(makeVector({0.2, -0.3, 0.1}), kNoise, 1);
  const VectorXd of_b_ = b_.measure(makeVector({0.2, -0.3, -0.2}), kNoise, 2);
  PosteriorProblem problem_ = join(a_, b_, of_a_, of_b_);
  const SimulatorPosteriorOptions options_ = [] {
    SimulatorPosteriorOptions options;
    options.draws = 4000;
    return options;
  }();
};

TEST_F(JointPosterior, IsLeastSquaresOfAllMeasurements) {
  problem_.drawn = 4;
  const SimulatorPosterior posterior = samplePosterior(problem_, MatrixXd(4, 0), options_);
  expectLeastSquares(posterior, matrix_a_, matrix_b_, of_a_, of_b_);
}

TEST_F(JointPosterior, IntegratesOutWhatIsOfOneMeasurementAlone) {
  problem_.drawn = 2;
  const SimulatorPosterior posterior = samplePosterior(problem_, MatrixXd(4, 0), options_);
  EXPECT_EQ(posterior.mean.size(), 2);
  EXPECT_EQ(posterior.best.size(), 4);
  expectLeastSquares(posterior, matrix_a_, matrix_b_, of_a_, of_b_);
}

TEST_F(JointPosterior, APriorIsAMeasurementMore) {
  problem_.drawn = 2;
  problem_.unknown[0].prior = PriorSpec{NormalPrior{0.3, 0.02}};
  const SimulatorPosterior with = samplePosterior(problem_, MatrixXd(4, 0), options_);
  problem_.unknown[0].prior.reset();
  const SimulatorPosterior without = samplePosterior(problem_, MatrixXd(4, 0), options_);
  ASSERT_TRUE(with.isReliable() && without.isReliable());
  const double precision = 1.0 / (without.stddev[0] * without.stddev[0]), of_prior = 1.0 / (0.02 * 0.02);
  const double stddev = 1.0 / std::sqrt(precision + of_prior);
  EXPECT_NEAR(with.stddev[0] / stddev, 1.0, 0.06);
  EXPECT_NEAR(with.mean[0], (precision * without.mean[0] + of_prior * 0.3) / (precision + of_prior),
              0.1 * stddev);
}

TEST_F(JointPosterior, IsUninformativeWhereItIsAsWideAsThePrior) {
  problem_.drawn = 2;
  problem_.unknown[0].prior = PriorSpec{NormalPrior{0.2, 1e-3}};  // the measurements allow some .02
  const SimulatorPosterior posterior = samplePosterior(problem_, MatrixXd(4, 0), options_);
  ASSERT_TRUE(posterior.isReliable());
  EXPECT_NEAR(posterior.prior_stddev[0], 1e-3, 1e-5);
  EXPECT_NEAR(posterior.prior_stddev[1], 2.0 / std::sqrt(12.0), 1e-3);
  EXPECT_EQ(posterior.findShape(2), PosteriorShape::kUninformative);
  problem_.unknown[0].prior.reset();
  EXPECT_EQ(samplePosterior(problem_, MatrixXd(4, 0), options_).findShape(2), PosteriorShape::kInformative);
}

}  // namespace
}  // namespace twinmap
