#include "framework/experiment/points/prior.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "framework/experiment/points/experiment_points.hpp"
#include "framework/experiment/points/point_set.hpp"
#include "framework/experiment/points/prior_marginal.hpp"
#include "framework/experiment/points/prior_text.hpp"
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

/// Per width of bounds (u): the information of independent parameters.
VectorXd calcScaledInformation(const std::vector<ParameterSpec>& unknown, const VectorXd& x) {
  return Prior(unknown, {}).calcInformation(x).front().diagonal();
}

TEST(Prior, InformationIsThatOfTheVarianceWithinTheBounds) {
  const std::vector<ParameterSpec> unknown{makeParameter("normal", 0.0, 20.0, {NormalPrior{10.0, 0.5}}),
                                           makeParameter("lognormal", 0.1, 40.0, {LognormalPrior{2.0, 1.5}}),
                                           makeUniform("uniform", 0.0, 7.0),
                                           makeParameter("beta", 1.0, 3.0, {BetaPrior{2.0, 5.0}}),
                                           makeParameter("level", 2.0, 3.0, {NormalPrior{0.0, 300.0}}),
                                           makeParameter("log_uniform", 0.1, 10.0, {LogUniformPrior{}})};
  VectorXd x(6);
  x << 9.7, 3.0, 1.0, 1.5, 2.2, 4.0;
  const VectorXd found = calcScaledInformation(unknown, x);
  const double decades = std::log(100.0);
  VectorXd expected(6);
  expected << std::pow(20.0 / 0.5, 2), std::pow(39.9 / (3.0 * std::log(1.5)), 2), 12.0,
      std::pow(7.0, 2) * 8.0 / 10.0, 12.0, 12.0 * std::pow(9.9 / (4.0 * decades), 2);
  for (Index j = 0; j < 6; ++j) {
    EXPECT_NEAR(found[j] / expected[j], 1.0, 6e-3) << unknown[static_cast<std::size_t>(j)].name.text;
  }
  EXPECT_EQ(found[2], 12.0);
  EXPECT_TRUE(Prior({makeUniform("a", 0.0, 1.0)}, {}).calcInformation(takeOne(0.5)).empty());
}

TEST(Prior, InformationOfCorrelatedParametersIsTheInverseOfTheirCovariance) {
  const std::vector<ParameterSpec> unknown{makeUniform("a", -9.0, 9.0), makeUniform("free", 0.0, 1.0),
                                           makeUniform("b", -9.0, 9.0)};
  const JointNormalPrior joint{{{"b", {}}, {"a", {}}}, {1.0, 2.0}, {0.5, 0.3, 0.3, 0.4}};
  Eigen::Matrix2d covariance;
  covariance << 0.4, 0.3, 0.3, 0.5;
  const MatrixXd found =
      Prior(unknown, {{joint, {}}}).calcInformation(Eigen::Vector3d(2.0, 0.5, 1.0)).front();
  const Eigen::Matrix2d expected = 18.0 * 18.0 * covariance.inverse();
  EXPECT_LT((MatrixXd(found({0, 2}, {0, 2})) - expected).norm(), 6e-3 * expected.norm());
  EXPECT_EQ(found(1, 1), 12.0);
  EXPECT_EQ(found(0, 1), 0.0);
}

/// Moments of the first two parameters of test points.
struct PointMoments {
  Eigen::Vector2d mean;
  Eigen::Matrix2d covariance;
};

PointMoments drawTestPoints(const std::vector<ParameterSpec>& unknown,
                            const std::vector<PriorGroupSpec>& groups, int count) {
  ExperimentSpec experiment;
  experiment.model.parameters = unknown;
  experiment.model.priors = groups;
  experiment.design.test.method = DesignMethod::kUniform;
  experiment.design.test.samples = count;
  const MatrixXd points = sampleTestPoints(experiment).topRows(2);
  const Eigen::Vector2d mean = points.rowwise().mean();
  const MatrixXd apart = points.colwise() - mean;
  return {mean, apart * apart.transpose() / count};
}

// a and b with correlation .8, of which the bounds leave a corner: moments by quadrature over the density
TEST(Prior, TestPointsAreDrawsWhereBoundsCutOffCorrelatedPriors) {
  const std::vector<ParameterSpec> unknown{makeParameter("a", -0.5, 3.0, {NormalPrior{0.0, 1.0}}),
                                           makeParameter("b", -3.0, -0.2, {NormalPrior{0.0, 1.0}})};
  const std::vector<PriorGroupSpec> groups{{CorrelatedPriors{{{"a", {}}, {"b", {}}}, 0.8}, {}}};
  const Prior prior(unknown, groups);
  constexpr int kCells = 150;
  double sum = 0.0;
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  Eigen::Matrix2d square = Eigen::Matrix2d::Zero();
  for (int i = 0; i < kCells; ++i) {
    for (int k = 0; k < kCells; ++k) {
      const Eigen::Vector2d x(-0.5 + 3.5 * (i + 0.5) / kCells, -3.0 + 2.8 * (k + 0.5) / kCells);
      const double density = std::exp(prior.calcLogDensity(x));
      sum += density;
      mean += density * x;
      square += density * x * x.transpose();
    }
  }
  mean /= sum;
  const Eigen::Matrix2d covariance = square / sum - mean * mean.transpose();
  constexpr int kDraws = 6000;
  const PointMoments found = drawTestPoints(unknown, groups, kDraws);
  for (Index j = 0; j < 2; ++j) {
    EXPECT_NEAR(found.mean[j], mean[j], 4.0 * std::sqrt(covariance(j, j) / kDraws));
  }
  EXPECT_LT((found.covariance - covariance).norm(), 0.08 * covariance.norm());
}

TEST(Prior, TestPointsOfUniformParametersKeepTheirBits) {
  const std::vector<ParameterSpec> unknown{makeUniform("a", -0.1, 3.0), makeUniform("b", 5.0, 7.0)};
  ExperimentSpec experiment;
  experiment.model.parameters = unknown;
  experiment.design.test.method = DesignMethod::kUniform;
  experiment.design.test.samples = 40;
  EXPECT_EQ(sampleTestPoints(experiment),
            samplePoints(experiment.design.test, unknown, experiment.seed, RandomPurpose::kTestDesign));
}

TEST(Prior, TrainingPointsAreItsQuantilesAtThoseOfTheDesign) {
  ExperimentSpec experiment;
  experiment.model.parameters = {makeParameter("a", -4.0, 4.0, {NormalPrior{0.5, 1.0}}),
                                 makeUniform("b", 5.0, 7.0)};
  experiment.inverse_map.kind = GpMapSpec{};
  experiment.design.train.method = DesignMethod::kLatinHypercube;
  experiment.design.train.samples = 400;
  const MatrixXd points = sampleTrainPoints(experiment);
  const MatrixXd unit =
      sampleUnitCube(experiment.design.train, 2, experiment.seed, RandomPurpose::kTrainDesign);
  EXPECT_NEAR(points.row(0).mean(), 0.5, 0.01);
  EXPECT_EQ(points.row(1), scaleToBounds(unit, experiment.model.parameters).row(1));
  const Prior prior(experiment.model.parameters, {});
  EXPECT_EQ(points.col(7), prior.calcPoint(unit.col(7)));
}

TEST(Prior, IsStatedInWords) {
  ModelSpec model;
  model.parameters = {makeParameter("k", 100.0, 300.0, {NormalPrior{200.0, 5.0}}),
                      makeParameter("m", 1.0, 3.0, {LognormalPrior{2.0, 1.1}}), makeUniform("d", 0.0, 1.0)};
  model.parameters[0].unit = "N/m";
  EXPECT_EQ(describePriors(model),
            "k normal 200 +- 5 N/m, m lognormal 2 within a factor of 1.1; the others uniform within their "
            "bounds");
  model.priors = {{CorrelatedPriors{{{"k", {}}, {"m", {}}}, 0.5}, {}}};
  model.parameters.pop_back();
  EXPECT_EQ(describePriors(model),
            "k normal 200 +- 5 N/m, m lognormal 2 within a factor of 1.1, correlation of k and m 0.5");
  EXPECT_EQ(describePriors(ModelSpec()), "");
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
