#include <gtest/gtest.h>

#include <cmath>

#include "kernels/linalg/decompositions.hpp"
#include "kernels/surrogate/fit_slopes.hpp"
#include "kernels/surrogate/shared_process.hpp"
#include "tests/kernels/support/random_data.hpp"

namespace twinmap::gp {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using test::randomMatrix;

constexpr SmoothCovariance kBoth[] = {SmoothCovariance::kSquaredExponential, SmoothCovariance::kMatern52};

SharedHyperparameters makeHyperparameters() {
  return {(VectorXd(3) << 0.9, 1.4, 2.0).finished(), 1e-6, 1e-6};
}

/// Two functions of three variables, in units of their measurement's noise.
VectorXd calcAt(const VectorXd& x) {
  return (VectorXd(2) << 200.0 * std::sin(3.0 * x(0) + x(1)), 5.0 * std::exp(x(0) * x(2)) + x(1)).finished();
}

/// Their derivatives with respect to the first two variables, by hand.
MatrixXd calcSlopesAt(const VectorXd& x) {
  const double rise = 200.0 * std::cos(3.0 * x(0) + x(1));
  return (MatrixXd(2, 2) << 3.0 * rise, rise, 5.0 * x(2) * std::exp(x(0) * x(2)), 1.0).finished();
}

MatrixXd calcValues(const MatrixXd& points) {
  MatrixXd values(points.cols(), 2);
  for (Index i = 0; i < points.cols(); ++i) {
    values.row(i) = calcAt(points.col(i)).transpose();
  }
  return values;
}

/// At the first `count` points.
SlopeData calcSlopes(const MatrixXd& points, Index count) {
  SlopeData slopes{MatrixXd(2 * count, 2), 2};
  for (Index i = 0; i < count; ++i) {
    const MatrixXd at = calcSlopesAt(points.col(i));
    slopes.values.row(i) = at.col(0).transpose();
    slopes.values.row(count + i) = at.col(1).transpose();
  }
  return slopes;
}

VectorXd evaluate(const SharedProcess& process, const VectorXd& point) {
  SharedProcess::Workspace workspace;
  VectorXd values(process.getFunctionCount());
  process.evaluate(point, values, workspace);
  return values;
}

TEST(JointCovariance, SlopesAreDerivativesOfTheCovarianceOfValues) {
  constexpr double kStep = 1e-4;
  const SharedHyperparameters numbers = makeHyperparameters();
  const MatrixXd pair = randomMatrix(3, 2, 3);
  for (const SmoothCovariance covariance : kBoth) {
    const auto covarianceOf = [&](const VectorXd& x, const VectorXd& z) {
      MatrixXd points(3, 2), found, slopes;
      points << x, z;
      calcSharedCovariance({covariance}, numbers, points, found, slopes);
      return found(1, 0);
    };
    const MatrixXd joint = calcJointCovariance({covariance}, numbers, pair, 2, 2);
    for (Index v = 0; v < 2; ++v) {
      const VectorXd along = kStep * VectorXd::Unit(3, v);
      const double once =
          (covarianceOf(pair.col(1), pair.col(0) + along) - covarianceOf(pair.col(1), pair.col(0) - along)) /
          (2.0 * kStep) * numbers.length_scales(v);
      EXPECT_NEAR(joint(2 + 2 * v, 1), once, 1e-7);
      for (Index w = 0; w < 2; ++w) {
        const VectorXd other = kStep * VectorXd::Unit(3, w);
        const double twice = (covarianceOf(pair.col(1) + other, pair.col(0) + along) -
                              covarianceOf(pair.col(1) - other, pair.col(0) + along) -
                              covarianceOf(pair.col(1) + other, pair.col(0) - along) +
                              covarianceOf(pair.col(1) - other, pair.col(0) - along)) /
                             (4.0 * kStep * kStep) * numbers.length_scales(v) * numbers.length_scales(w);
        EXPECT_NEAR(joint(2 + 2 * v, 3 + 2 * w), twice, 1e-6);
      }
    }
  }
}

TEST(SharedProcess, WithSlopesPassesThroughValuesAndSlopes) {
  const MatrixXd points = randomMatrix(3, 30, 1);
  for (const SmoothCovariance covariance : kBoth) {
    const SharedProcess process(points, calcValues(points), calcSlopes(points, 20),
                                {covariance, Trend::kLinear, true}, makeHyperparameters());
    SharedProcess::Workspace workspace;
    VectorXd values(2);
    MatrixXd jacobian(2, 3);
    for (const Index i : {Index{0}, Index{19}}) {
      process.linearize(points.col(i), values, jacobian, workspace);
      EXPECT_LT((values - calcAt(points.col(i))).cwiseAbs().maxCoeff(), 0.05);
      EXPECT_LT((jacobian.leftCols(2) - calcSlopesAt(points.col(i))).cwiseAbs().maxCoeff(), 0.5);
    }
  }
}

TEST(SharedProcess, WithSlopesLeavesAPointOutAsIfTheOthersWereFittedAnew) {
  const MatrixXd points = randomMatrix(3, 30, 1), values = calcValues(points);
  const SharedStructure structure{SmoothCovariance::kMatern52, Trend::kQuadratic, true};
  const SharedProcess process(points, values, calcSlopes(points, 20), structure, makeHyperparameters());
  const MatrixXd others = points.rightCols(29);
  const SharedProcess without(others, values.bottomRows(29), calcSlopes(others, 19), structure,
                              makeHyperparameters());
  const VectorXd residual = values.row(0).transpose() - evaluate(without, points.col(0));
  EXPECT_LT((process.getLeftOut().residual.row(0).transpose() - residual).cwiseAbs().maxCoeff(),
            1e-6 * values.cwiseAbs().maxCoeff());
}

TEST(SharedProcess, WithSlopesItsDerivativesAreThoseOfItsValues) {
  constexpr double kStep = 1e-5;
  const MatrixXd points = randomMatrix(3, 30, 1);
  const VectorXd at = (VectorXd(3) << 0.1, -0.3, 0.2).finished();
  for (const SmoothCovariance covariance : kBoth) {
    const SharedProcess process(points, calcValues(points), calcSlopes(points, 20),
                                {covariance, Trend::kQuadratic, true}, makeHyperparameters());
    SharedProcess::Workspace workspace;
    VectorXd values(2);
    MatrixXd jacobian(2, 3);
    process.linearize(at, values, jacobian, workspace);
    for (Index v = 0; v < 3; ++v) {
      const VectorXd moved = kStep * VectorXd::Unit(3, v);
      const VectorXd expected =
          (evaluate(process, at + moved) - evaluate(process, at - moved)) / (2.0 * kStep);
      EXPECT_LT((jacobian.col(v) - expected).cwiseAbs().maxCoeff(), 1e-3);  // rounding of 1e3 / the step
    }
  }
}

TEST(SharedProcess, EvaluatesTheFirstFunctionsAlone) {
  const MatrixXd points = randomMatrix(3, 30, 1);
  const VectorXd at = VectorXd::Constant(3, 0.2);
  const SharedProcess process(points, calcValues(points), calcSlopes(points, 20),
                              {SmoothCovariance::kMatern52, Trend::kLinear, true}, makeHyperparameters());
  SharedProcess::Workspace workspace;
  VectorXd first(1), all(2);
  MatrixXd jacobian(1, 2), of_all(2, 2);
  process.linearize(at, first, jacobian, workspace);
  process.linearize(at, all, of_all, workspace);
  EXPECT_NEAR(first(0), all(0), 1e-9 * std::abs(all(0)));  // summed in another order
  EXPECT_TRUE(jacobian.isApprox(of_all.topRows(1), 1e-12));
}

TEST(SharedProcess, RefusesSlopesOfOtherFunctionsOrPoints) {
  const MatrixXd points = randomMatrix(3, 30, 1), values = calcValues(points);
  const SharedStructure structure{SmoothCovariance::kMatern52, Trend::kLinear, true};
  SlopeData slopes = calcSlopes(points, 30);
  slopes.values.conservativeResize(60, 1);
  EXPECT_THROW(SharedProcess(points, values, slopes, structure, makeHyperparameters()),
               std::invalid_argument);
  EXPECT_THROW(SharedProcess(points.leftCols(20), values.topRows(20), calcSlopes(points, 30), structure,
                             makeHyperparameters()),
               std::invalid_argument);
}

TEST(LocalVariance, OfFewPointsIsThatOfAll) {
  const SharedHyperparameters numbers = makeHyperparameters();
  const MatrixXd points = randomMatrix(3, 12, 4);
  const MatrixXd scaled = points.transpose() * numbers.length_scales.cwiseInverse().asDiagonal();
  for (const SmoothCovariance covariance : kBoth) {
    MatrixXd of_all, slopes;
    calcSharedCovariance({covariance}, numbers, points, of_all, slopes);
    // The first point is predicted by the others.
    const VectorXd cross = of_all.col(0).tail(11);
    const double expected = 1.0 + numbers.nugget -
                            cross.dot(linalg::solvePositiveDefinite(of_all.bottomRightCorner(11, 11), cross));
    PointCovariance at;
    const exact::smooth_process process = describeProcess(covariance, numbers.nugget, scaled, 0, 0);
    calcPointCovariance(process, scaled.row(0).transpose(), at);
    EXPECT_NEAR(exact::calcLocalVariance(process, at.getView(), 0), expected, 1e-10);
  }
}

/// Root mean square error, and that in predicted standard deviations, at points not seen.
struct Errors {
  double rms = 0.0, standardised = 0.0;
};

Errors measure(const SharedProcess& process) {
  const MatrixXd tests = randomMatrix(3, 300, 9);
  SharedProcess::Workspace workspace;
  VectorXd values(2), stddev(2);
  Errors sum;
  for (Index i = 0; i < tests.cols(); ++i) {
    process.evaluate(tests.col(i), values, workspace);
    process.calcStddev(stddev, workspace);
    const VectorXd error = values - calcAt(tests.col(i));
    sum.rms += error.squaredNorm();
    sum.standardised += error.cwiseQuotient(stddev).squaredNorm();
  }
  const double count = 2.0 * static_cast<double>(tests.cols());
  return {std::sqrt(sum.rms / count), std::sqrt(sum.standardised / count)};
}

TEST(ChooseWithSlopes, LearnsFromThemAndKnowsItsError) {
  const MatrixXd points = randomMatrix(3, 40, 1), values = calcValues(points);
  const SlopeData slopes = calcSlopes(points, 40);
  const SharedChoice by_values = chooseSharedProcess(points, values);
  const SharedChoice choice = chooseWithSlopes(by_values, points, values, slopes);
  ASSERT_TRUE(choice.structure.slopes);
  const Errors without = measure({points, values, by_values.structure, by_values.hyperparameters});
  const Errors with = measure({points, values, slopes, choice.structure, choice.hyperparameters});
  EXPECT_LT(with.rms, 0.3 * without.rms);
  EXPECT_GT(with.standardised, 0.3);
  EXPECT_LT(with.standardised, 3.0);
}

TEST(ChooseWithSlopes, LearnsNothingFromSlopesThatHaveNothingToDoWithTheValues) {
  const MatrixXd points = randomMatrix(3, 60, 1), values = calcValues(points);
  const SlopeData slopes{2000.0 * randomMatrix(120, 2, 5), 2};
  const SharedChoice by_values = chooseSharedProcess(points, values);
  const SharedChoice choice = chooseWithSlopes(by_values, points, values, slopes);
  // Either they are not taken, or as noise that changes nothing.
  const Errors without = measure({points, values, by_values.structure, by_values.hyperparameters});
  const Errors with = choice.structure.slopes
                          ? measure({points, values, slopes, choice.structure, choice.hyperparameters})
                          : without;
  EXPECT_LT(with.rms, 1.2 * without.rms);
}

TEST(SharedProcess, ManyPointsHaveTheValuesAndStandardDeviationsOfEach) {
  const MatrixXd points = randomMatrix(3, 70, 5), at = randomMatrix(3, 130, 6);
  const SharedStructure structure{SmoothCovariance::kMatern52, Trend::kLinear};
  const MatrixXd values = calcValues(points);
  for (const Index with_slopes : {0, 40}) {
    const SharedProcess process = with_slopes == 0
                                      ? SharedProcess(points, values, structure, makeHyperparameters())
                                      : SharedProcess(points, values, calcSlopes(points, with_slopes),
                                                      structure, makeHyperparameters());
    SharedProcess::Workspace one, many;
    MatrixXd all_values(2, at.cols()), all_stddev(2, at.cols());
    process.evaluateMany(at, all_values, all_stddev, many);
    for (Index i = 0; i < at.cols(); ++i) {
      VectorXd value(2), stddev(2);
      process.evaluate(at.col(i), value, one);
      process.calcStddev(stddev, one);
      EXPECT_EQ(all_values.col(i), value);
      EXPECT_LT((all_stddev.col(i) - stddev).norm(), 1e-9 * stddev.norm());
    }
  }
}

}  // namespace
}  // namespace twinmap::gp
