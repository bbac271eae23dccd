#include "framework/experiment/points/prior.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "kernels/linalg/decompositions.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

ParameterSpec makeParameter(const std::string& name, double lower, double upper, const PriorSpec& prior) {
  ParameterSpec parameter;
  parameter.name = {name, {}};
  parameter.bounds = {lower, upper, {}};
  parameter.prior = prior;
  return parameter;
}

ParameterSpec makeUniform(const std::string& name, double lower, double upper) {
  ParameterSpec parameter = makeParameter(name, lower, upper, {});
  parameter.prior.reset();
  return parameter;
}

VectorXd takeOne(double value) {
  return VectorXd::Constant(1, value);
}

/// The distribution function at the quantile of each probability, by the midpoint rule over the density.
void expectQuantilesOfTheDensity(const ParameterSpec& parameter) {
  const Prior prior({parameter}, {});
  constexpr int kCells = 20000;
  const Bounds& bounds = parameter.bounds;
  const double cell = (bounds.upper - bounds.lower) / kCells;
  std::vector<double> until(1, 0.0);
  for (int i = 0; i < kCells; ++i) {
    until.push_back(until.back() + std::exp(prior.calcLogDensity(takeOne(bounds.lower + (i + 0.5) * cell))));
  }
  for (const double probability : {0.02, 0.3, 0.5, 0.9, 0.995}) {
    const double x = prior.calcPoint(takeOne(probability))[0];
    const auto i = static_cast<std::size_t>((x - bounds.lower) / cell);
    EXPECT_NEAR(until[std::min<std::size_t>(i, kCells)] / until.back(), probability, 2e-3)
        << parameter.name.text << " " << x;
  }
}

TEST(Prior, QuantilesAreThoseOfTheDensityWithinTheBounds) {
  expectQuantilesOfTheDensity(makeParameter("normal", 1.0, 6.0, {NormalPrior{2.0, 1.5}}));
  expectQuantilesOfTheDensity(makeParameter("tail", 5.0, 9.0, {NormalPrior{0.0, 1.5}}));
  expectQuantilesOfTheDensity(makeParameter("lognormal", 0.5, 20.0, {LognormalPrior{3.0, 2.0}}));
  expectQuantilesOfTheDensity(makeParameter("log_uniform", 0.1, 10.0, {LogUniformPrior{}}));
  expectQuantilesOfTheDensity(makeParameter("beta", -1.0, 3.0, {BetaPrior{2.0, 5.0}}));
  expectQuantilesOfTheDensity(makeParameter("student", -4.0, 9.0, {StudentPrior{1.0, 0.5, 4.0}}));
}

TEST(Prior, CorrelatedDrawsHaveTheirMomentsAndDensity) {
  const std::vector<ParameterSpec> unknown{makeParameter("a", -100.0, 100.0, {NormalPrior{2.0, 3.0}}),
                                           makeUniform("free", 0.0, 1.0),
                                           makeParameter("b", 1e-3, 1e3, {LognormalPrior{5.0, 1.5}})};
  const Prior prior(unknown, {{CorrelatedPriors{{{"a", {}}, {"b", {}}}, 0.6}, {}}});
  constexpr Index kDraws = 40000;
  MatrixXd z(2, kDraws);
  for (Index i = 0; i < kDraws; ++i) {  // points of a rank-one lattice fill the cube evenly
    const VectorXd unit = VectorXd::NullaryExpr(3, [&](Index j) {
      const double step = j == 0 ? 0.7548776662466927 : j == 1 ? 0.3 : 0.5698402909980532;
      const double at = 0.5 + step * static_cast<double>(i);
      return at - std::floor(at) + 1e-12;
    });
    const VectorXd x = prior.calcPoint(unit);
    z.col(i) = Eigen::Vector2d((x[0] - 2.0) / 3.0, std::log(x[2] / 5.0) / std::log(1.5));
  }
  EXPECT_NEAR(z.row(0).squaredNorm() / kDraws, 1.0, 0.01);
  EXPECT_NEAR(z.row(1).squaredNorm() / kDraws, 1.0, 0.01);
  EXPECT_NEAR(z.row(0).dot(z.row(1)) / kDraws, 0.6, 0.01);
  // the density of (a, log b) by its formula
  const auto density = [](double a, double b) {
    return -0.5 * (a * a - 2.0 * 0.6 * a * b + b * b) / (1.0 - 0.36);
  };
  const auto at = [](double a, double b) {
    return VectorXd(Eigen::Vector3d(2.0 + 3.0 * a, 0.5, 5.0 * std::pow(1.5, b)));
  };
  const double expected = density(1.0, -0.5) - density(0.2, 0.9) - std::log(1.5) * (-0.5 - 0.9);
  EXPECT_NEAR(prior.calcLogDensity(at(1.0, -0.5)) - prior.calcLogDensity(at(0.2, 0.9)), expected, 1e-12);
}

TEST(Prior, MisfitHasTheSlopeOfItsDescent) {
  const std::vector<ParameterSpec> unknown{makeParameter("a", -5.0, 5.0, {NormalPrior{1.0, 2.0}}),
                                           makeParameter("b", 0.5, 9.0, {LognormalPrior{2.0, 1.5}}),
                                           makeParameter("c", 0.0, 1.0, {BetaPrior{3.0, 2.0}}),
                                           makeParameter("d", -9.0, 9.0, {StudentPrior{0.0, 1.0, 3.0}})};
  const Prior prior(unknown, {{CorrelatedPriors{{{"a", {}}, {"b", {}}}, -0.4}, {}}});
  const VectorXd x = Eigen::Vector4d(2.5, 3.0, 0.3, 2.0);
  const PriorMisfit misfit = prior.calcMisfit(x);
  constexpr double kStep = 1e-6;
  for (Index j = 0; j < 4; ++j) {
    VectorXd up = x, down = x;
    up[j] += kStep;
    down[j] -= kStep;
    const double slope = (prior.calcMisfit(up).misfit - prior.calcMisfit(down).misfit) / (2.0 * kStep);
    EXPECT_NEAR(slope, -2.0 * misfit.descent[j], 1e-6 * (1.0 + std::abs(slope)));
  }
  EXPECT_TRUE(linalg::calcCholesky(misfit.information + 1e-9 * MatrixXd::Identity(4, 4)).positive_definite);
}

TEST(Prior, JointNormalOfAnEarlierEstimateIsItsMeanAndCovariance) {
  const std::vector<ParameterSpec> unknown{makeUniform("a", -9.0, 9.0), makeUniform("b", -9.0, 9.0)};
  const JointNormalPrior joint{{{"b", {}}, {"a", {}}}, {1.0, 2.0}, {0.5, 0.3, 0.3, 0.4}};
  const Prior prior(unknown, {{joint, {}}});
  Eigen::Matrix2d covariance;
  covariance << 0.4, 0.3, 0.3, 0.5;
  const Eigen::Vector2d mean(2.0, 1.0), x(2.4, 0.1), y(1.0, 1.5);
  const auto density = [&](const Eigen::Vector2d& at) {
    return -0.5 * (at - mean).dot(covariance.inverse() * (at - mean));
  };
  EXPECT_NEAR(prior.calcLogDensity(x) - prior.calcLogDensity(y), density(x) - density(y), 1e-12);
  EXPECT_NEAR(prior.calcMisfit(mean).misfit, 0.0, 1e-12);
}

TEST(Prior, RefusesGroupsThatItCannotJoin) {
  const std::vector<ParameterSpec> unknown{makeUniform("a", -9.0, 9.0),
                                           makeParameter("b", -9.0, 9.0, {NormalPrior{0.0, 1.0}})};
  EXPECT_THROW(Prior(unknown, {{CorrelatedPriors{{{"a", {}}, {"b", {}}}, 0.5}, {}}}), ExperimentError);
  EXPECT_THROW(Prior(unknown, {{JointNormalPrior{{{"c", {}}}, {0.0}, {1.0}}, {}}}), ExperimentError);
  EXPECT_THROW(Prior(unknown, {{JointNormalPrior{{{"a", {}}}, {0.0}, {-1.0}}, {}}}), ExperimentError);
}

TEST(Prior, RangeHoldsAllButATenThousandth) {
  const Bounds normal = calcPriorRange({NormalPrior{2.0, 3.0}});
  EXPECT_NEAR((normal.upper - 2.0) / 3.0, 3.8906, 1e-4);
  EXPECT_NEAR(normal.lower + normal.upper, 4.0, 1e-12);
  const Bounds lognormal = calcPriorRange({LognormalPrior{2.0, 1.5}});
  EXPECT_NEAR(lognormal.lower * lognormal.upper, 4.0, 1e-12);
  EXPECT_NEAR(calcPriorRange({StudentPrior{0.0, 1.0, 1.0}}).upper, 1.0 / std::tan(std::acos(-1.0) * 0.5e-4),
              1e-3);  // Cauchy's quantile
}

}  // namespace
}  // namespace twinmap
