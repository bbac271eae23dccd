#include "framework/estimation/surrogate/posterior/posterior_sampler.hpp"

#include <gtest/gtest.h>

#include <cfloat>
#include <cmath>
#include <functional>

#include "framework/base/random/random.hpp"
#include "framework/estimation/surrogate/posterior/score_likelihood.hpp"
#include "tests/framework/support/linear_simulator.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

using Scores = std::function<VectorXd(const VectorXd& normalised)>;

constexpr int kDraws = 4000;

/// A surrogate that is exact where the scores are polynomials of degree two: they are its trend.
std::shared_ptr<const ForwardSurrogate> makeForward(Index variables, const Scores& scores) {
  constexpr Index kPoints = 80;
  const RandomStream random(3, RandomPurpose::kTrainDesign);
  auto forward = std::make_shared<ForwardSurrogate>();
  forward->points.resize(variables, kPoints);
  const Index r = scores(VectorXd::Zero(variables)).size();
  forward->scores.resize(r, kPoints);
  for (Index i = 0; i < kPoints; ++i) {
    for (Index k = 0; k < variables; ++k) {
      forward->points(k, i) = 2.0 * random.calcUniform(i, k) - 1.0;
    }
    forward->scores.col(i) = scores(forward->points.col(i));
  }
  const gp::SharedStructure structure{gp::SmoothCovariance::kSquaredExponential, gp::Trend::kQuadratic,
                                      false};
  forward->windows.emplace_back(forward->points, forward->scores.transpose(), structure,
                                gp::SharedHyperparameters{VectorXd::Constant(variables, 1.0), 1e-8, 1e-8});
  forward->center = VectorXd::Zero(r);
  forward->projection = MatrixXd::Identity(r, r);
  forward->error_correlation = MatrixXd::Identity(r, r);
  forward->error_variance = VectorXd::Zero(r);
  return forward;
}

PosteriorModel makeModel(std::shared_ptr<const ForwardSurrogate> forward, Index parameters) {
  const Index m = forward->points.rows();
  return {std::move(forward), VectorXd::Zero(m),   VectorXd::Ones(m),
          parameters,         makeUniformPrior(m), VectorXd::Ones(parameters)};
}

/// Of two variables in the box, by the midpoint rule: the cumulative distribution of the first, its mean and
/// its standard deviation.
struct Quadrature {
  VectorXd ends, cumulative;
  double mean = 0.0, stddev = 0.0;

  double calcQuantile(double probability) const {
    const Index i = std::lower_bound(cumulative.begin(), cumulative.end(), probability) - cumulative.begin();
    return ends[i];
  }
};

Quadrature integrate(const Scores& forward, const VectorXd& scores) {
  constexpr Index kCells = 1000;
  const auto place = [](Index i) { return -1.0 + (2.0 * static_cast<double>(i) + 1.0) / kCells; };
  VectorXd density = VectorXd::Zero(kCells);
  for (Index i = 0; i < kCells; ++i) {
    for (Index j = 0; j < kCells; ++j) {
      density[i] += std::exp(-0.5 * (scores - forward(Vector2d(place(i), place(j)))).squaredNorm());
    }
  }
  density /= density.sum();
  Quadrature found{VectorXd(kCells), VectorXd(kCells)};
  double sum = 0.0, square = 0.0;
  for (Index i = 0; i < kCells; ++i) {
    found.ends[i] = place(i) + 1.0 / kCells;
    found.cumulative[i] = sum += density[i];
    found.mean += density[i] * place(i);
    square += density[i] * place(i) * place(i);
  }
  found.stddev = std::sqrt(square - found.mean * found.mean);
  return found;
}

void expectAgreement(const SurrogatePosterior& posterior, const Quadrature& exact) {
  ASSERT_TRUE(posterior.isReliable()) << posterior.message;
  const double error = exact.stddev / std::sqrt(posterior.effective_sample_size);
  EXPECT_NEAR(posterior.mean[0], exact.mean, 4.0 * error);
  EXPECT_NEAR(posterior.stddev[0], exact.stddev, 4.0 * error);
  EXPECT_NEAR(posterior.draws.row(0).mean(), exact.mean,
              4.0 * (error + exact.stddev / std::sqrt(static_cast<double>(posterior.draws.cols()))));
  for (const double probability : {0.025, 0.16, 0.5, 0.84, 0.975}) {
    const double spread =
        4.0 * std::sqrt(probability * (1.0 - probability) / posterior.effective_sample_size);
    const double found =
        importance::calcQuantiles(posterior.weighted, VectorXd::Constant(1, probability))(0, 0);
    EXPECT_GE(found, exact.calcQuantile(std::max(probability - spread, 1e-4)) - 0.01);
    EXPECT_LE(found, exact.calcQuantile(std::min(probability + spread, 1.0 - 1e-4)) + 0.01);
  }
}

VectorXd calcThreeFeatures(const VectorXd& x) {
  return Eigen::Vector3d(4.0 * x[0] + x[1], 3.0 * x[1] - 2.0 * x[0], 0.5 * x[0]);
}

TEST(PosteriorSampler, AgreesWithQuadratureOfALinearModelWithinTheBox) {
  PosteriorSampler sampler(makeModel(makeForward(2, calcThreeFeatures), 2), kDraws, 1);
  const VectorXd scores = calcThreeFeatures(Vector2d(0.3, -0.2)) + Eigen::Vector3d(0.5, -0.8, 0.3);
  const SurrogatePosterior posterior = sampler.sample(scores, VectorXd());
  expectAgreement(posterior, integrate(calcThreeFeatures, scores));
  EXPECT_GT(posterior.effective_sample_size, 0.6 * kDraws);
  EXPECT_EQ(posterior.evaluations, kDraws);
}

/// Two parameters within [-1, 1], the first normal about 0.1.
ModelSpec makeModelWithPrior(double stddev) {
  ModelSpec model;
  model.parameters = testing::makeParameters(2, -1.0, 1.0);
  model.parameters[0].prior = PriorSpec{NormalPrior{0.1, stddev}};
  return model;
}

TEST(PosteriorSampler, TakesANormalPriorAsAMeasurementMore) {
  constexpr double kStddev = 0.05;
  const ModelSpec spec = makeModelWithPrior(kStddev);
  PosteriorModel model = makeModel(makeForward(2, calcThreeFeatures), 2);
  model.prior = makeBoxPrior(spec);
  model.density = findPrior(spec);
  PosteriorSampler sampler(model, kDraws, 1);
  const VectorXd scores = calcThreeFeatures(Vector2d(0.3, -0.2)) + Eigen::Vector3d(0.5, -0.8, 0.3);
  const SurrogatePosterior posterior = sampler.sample(scores, VectorXd());

  const auto with_prior = [&](const VectorXd& x) -> VectorXd {
    VectorXd features(4);
    features << calcThreeFeatures(x), x[0] / kStddev;
    return features;
  };
  VectorXd measured(4);
  measured << scores, 0.1 / kStddev;
  const Quadrature exact = integrate(with_prior, measured);
  expectAgreement(posterior, exact);
  EXPECT_NEAR(posterior.normal_mean[0], exact.mean, 0.02 * exact.stddev);
  EXPECT_NEAR(std::sqrt(posterior.normal_covariance(0, 0)), exact.stddev, 0.02 * exact.stddev);
}

TEST(PosteriorSampler, LeansOnTheBoundsAsThePosteriorDoes) {
  PosteriorSampler sampler(makeModel(makeForward(2, calcThreeFeatures), 2), kDraws, 1);
  const VectorXd scores = calcThreeFeatures(Vector2d(0.98, -0.9)) + Eigen::Vector3d(0.7, 0.2, -0.4);
  const SurrogatePosterior posterior = sampler.sample(scores, VectorXd());
  expectAgreement(posterior, integrate(calcThreeFeatures, scores));
  EXPECT_LE(posterior.draws.maxCoeff(), 1.0);
}

TEST(PosteriorSampler, FindsBothPlacesWhereTheSignIsNotTold) {
  const auto forward = [](const VectorXd& x) -> VectorXd { return Vector2d(8.0 * x[0] * x[0], 5.0 * x[1]); };
  PosteriorSampler sampler(makeModel(makeForward(2, forward), 2), kDraws, 1);
  const VectorXd scores = Vector2d(4.2, 1.0);
  const SurrogatePosterior posterior = sampler.sample(scores, VectorXd());
  const Quadrature exact = integrate(forward, scores);
  ASSERT_GT(exact.stddev, 0.6);
  expectAgreement(posterior, exact);
}

TEST(PosteriorSampler, FollowsABentValleyThatOneNormalDistributionDoesNot) {
  const auto forward = [](const VectorXd& x) -> VectorXd {
    return Vector2d(12.0 * (x[1] - 1.2 * x[0] * x[0] + 0.6), 0.8 * x[0]);
  };
  PosteriorSampler sampler(makeModel(makeForward(2, forward), 2), kDraws, 1);
  const VectorXd scores = Vector2d(0.4, 0.1);
  const SurrogatePosterior posterior = sampler.sample(scores, VectorXd());
  expectAgreement(posterior, integrate(forward, scores));
}

TEST(PosteriorSampler, MarginalisesNuisanceParametersAndHoldsKnownInputs) {
  const auto forward = [](const VectorXd& x) -> VectorXd {  // updating, nuisance, known
    return Vector2d(5.0 * x[0] + 2.0 * x[1] + 3.0 * x[2], 4.0 * x[1]);
  };
  PosteriorModel model = makeModel(makeForward(3, forward), 1);
  model.prior = makeUniformPrior(2);
  PosteriorSampler sampler(model, kDraws, 1);
  const double known = 0.5;
  const VectorXd scores = Vector2d(2.0, -0.6);
  const auto held = [&](const VectorXd& x) { return forward(Eigen::Vector3d(x[0], x[1], known)); };
  const SurrogatePosterior posterior = sampler.sample(scores, VectorXd::Constant(1, known));
  expectAgreement(posterior, integrate(held, scores));
  EXPECT_EQ(posterior.mean.size(), 1);
  EXPECT_EQ(posterior.draws.rows(), 2);
}

TEST(PosteriorSampler, ACalibratedScaleWidensWithinTheBox) {
  PosteriorModel model = makeModel(makeForward(2, calcThreeFeatures), 2);
  const VectorXd scores = calcThreeFeatures(Vector2d(0.1, 0.0));
  const SurrogatePosterior narrow = PosteriorSampler(model, kDraws, 1).sample(scores, VectorXd());
  model.stddev_scale = Vector2d(1.4, 1.0);
  const SurrogatePosterior wide = PosteriorSampler(model, kDraws, 1).sample(scores, VectorXd());
  EXPECT_NEAR(wide.stddev[0] / narrow.stddev[0], 1.4, 0.07);
  EXPECT_NEAR(wide.stddev[1] / narrow.stddev[1], 1.0, 0.05);
  EXPECT_LE(wide.draws.cwiseAbs().maxCoeff(), 1.0);
}

TEST(PosteriorSampler, TheSameMeasurementGivesTheSameBitsWhateverCameBefore) {
  const PosteriorModel model = makeModel(makeForward(2, calcThreeFeatures), 2);
  const VectorXd scores = calcThreeFeatures(Vector2d(0.3, -0.2));
  PosteriorSampler fresh(model, kMinPosteriorDraws, 1), used(model, kMinPosteriorDraws, 1);
  (void)used.sample(calcThreeFeatures(Vector2d(-0.9, 0.9)), VectorXd(), 5);
  const SurrogatePosterior a = fresh.sample(scores, VectorXd()), b = used.sample(scores, VectorXd());
  EXPECT_EQ(a.mean, b.mean);
  EXPECT_EQ(a.draws, b.draws);
  EXPECT_EQ(a.pareto_shape, b.pareto_shape);
  EXPECT_NE(a.mean, PosteriorSampler(model, kMinPosteriorDraws, 2).sample(scores, VectorXd()).mean);
  EXPECT_NE(a.mean, fresh.sample(scores, VectorXd(), 1).mean);
}

/// A needle in a shell of six dimensions, of which 200 draws a round hit nothing twice.
TEST(PosteriorSampler, GivesNoNumbersWhereItHasNotFoundThePosterior) {
  const auto forward = [](const VectorXd& x) -> VectorXd {
    return Vector2d(4000.0 * (x.squaredNorm() - 0.8), 3000.0 * (x[0] * x[1] + x[2] * x[3] - x[4] * x[5]));
  };
  PosteriorSampler sampler(makeModel(makeForward(6, forward), 6), kMinPosteriorDraws, 1);
  const SurrogatePosterior posterior = sampler.sample(Vector2d(0.3, 0.1), VectorXd());
  EXPECT_FALSE(posterior.isReliable());
  EXPECT_NE(posterior.message, "");
  EXPECT_EQ(posterior.mean.size(), 0);
  EXPECT_EQ(posterior.draws.size(), 0);
}

TEST(ScoreLikelihood, IsTheFormulaWithTheErrorsOfTheSurrogate) {
  const auto rough = [](const VectorXd& x) -> VectorXd {
    return Vector2d(3.0 * std::sin(9.0 * x[0]), 2.0 * std::cos(7.0 * x[0]));
  };
  auto forward = std::make_shared<ForwardSurrogate>(*makeForward(1, rough));
  forward->error_correlation << 1.0, 0.6, 0.6, 1.0;
  const VectorXd at = VectorXd::Constant(1, 0.9), scores = Vector2d(0.5, -1.0);
  VectorXd values(2), stddev(2);
  gp::SharedProcess::Workspace workspace;
  forward->windows[0].evaluate(at, values, workspace);
  forward->windows[0].calcStddev(stddev, workspace);
  const double wide = 1.5, a = 1.0 + std::pow(wide * stddev[0], 2), b = 1.0 + std::pow(wide * stddev[1], 2),
               c = 0.6 * wide * wide * stddev[0] * stddev[1], determinant = a * b - c * c;
  const Vector2d r = scores - values;
  const double expected = -0.5 * ((b * r[0] * r[0] - 2.0 * c * r[0] * r[1] + a * r[1] * r[1]) / determinant +
                                  std::log(determinant));
  ScoreLikelihood likelihood(*forward);
  likelihood.setMeasurement(scores, VectorXd(), {wide});
  const VectorXd logs = likelihood.calcLogs((MatrixXd(1, 3) << 1.0001, 0.9, -1.5).finished());
  EXPECT_EQ(logs[0], -INFINITY);
  // Blocks of points round differently from one point, by up to the condition of the kernel matrix, 80 /
  // 1e-8.
  EXPECT_NEAR(logs[1], expected, 80 / 1e-8 * DBL_EPSILON * std::abs(expected));
  EXPECT_EQ(logs[2], -INFINITY);
}

}  // namespace
}  // namespace twinmap
