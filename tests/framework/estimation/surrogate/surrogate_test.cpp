#include "framework/estimation/surrogate/surrogate.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "framework/base/random/random.hpp"
#include "framework/estimation/surrogate/fit_forward.hpp"
#include "framework/estimation/surrogate/train_surrogate.hpp"
#include "framework/estimation/surrogate/window_fit.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kNoise = 0.02;
constexpr Index kTimes = 24;

ParameterSpec makeParameter(const char* name, double lower, double upper) {
  ParameterSpec parameter;
  parameter.name.text = name;
  parameter.bounds.lower = lower;
  parameter.bounds.upper = upper;
  return parameter;
}

/// Points of the box, and noise.
MatrixXd samplePoints(const std::vector<ParameterSpec>& box, Index count, std::uint64_t seed) {
  const RandomStream random(seed, RandomPurpose::kTrainDesign);
  MatrixXd points(static_cast<Index>(box.size()), count);
  for (Index j = 0; j < count; ++j) {
    for (Index k = 0; k < points.rows(); ++k) {
      const Bounds& bounds = box[static_cast<std::size_t>(k)].bounds;
      points(k, j) = bounds.lower + (bounds.upper - bounds.lower) * random.calcUniform(j, k);
    }
  }
  return points;
}

MatrixXd addNoise(MatrixXd features, std::uint64_t seed) {
  const RandomStream random(seed, RandomPurpose::kTrainNoise);
  for (Index j = 0; j < features.cols(); ++j) {
    for (Index i = 0; i < features.rows(); ++i) {
      features(i, j) += kNoise * random.calcNormal(j, i);
    }
  }
  return features;
}

std::vector<FeatureInfo> makeInfos() {
  std::vector<FeatureInfo> infos;
  for (Index i = 0; i < kTimes; ++i) {
    infos.push_back({"", "m", 0, 0.1 * static_cast<double>(i + 1)});
  }
  return infos;
}

MatrixXd invert(const MatrixXd& a) {
  return linalg::solveCholesky(linalg::calcCholesky(a).lower, MatrixXd::Identity(a.rows(), a.cols()));
}

using Response = MatrixXd (*)(const MatrixXd& points);

/// Features linear in two parameters and, by a tenth as much, in a nuisance parameter.
MatrixXd calcLinear(const MatrixXd& points) {
  MatrixXd slopes(kTimes, 3);
  for (Index i = 0; i < kTimes; ++i) {
    slopes.row(i) << std::sin(0.5 * i), 0.3 * std::cos(0.3 * i), 0.02 * std::sin(0.2 * i + 1.0);
  }
  return slopes * points;
}

/// A decaying oscillation: damping, stiffness, and a known amplitude.
MatrixXd calcOscillation(const MatrixXd& points) {
  MatrixXd features(kTimes, points.cols());
  for (Index j = 0; j < points.cols(); ++j) {
    for (Index i = 0; i < kTimes; ++i) {
      const double t = 0.25 * static_cast<double>(i + 1);
      features(i, j) = points(2, j) * std::exp(-points(0, j) * t) * std::sin(points(1, j) * t);
    }
  }
  return features;
}

SurrogateSamples makeSamples(const MatrixXd& points, Response response) {
  const MatrixXd clean = response(points);
  return {makeInfos(), points, clean, kNoise * kNoise * MatrixXd::Identity(kTimes, kTimes),
          addNoise(clean, 5)};
}

ModelSpec makeLinearModel() {
  ModelSpec model;
  model.parameters = {makeParameter("a", 1.0, 3.0), makeParameter("b", -1.0, 1.0)};
  model.nuisance = {makeParameter("c", -1.0, 1.0)};
  return model;
}

ModelSpec makeOscillationModel() {
  ModelSpec model;
  model.parameters = {makeParameter("d", 0.1, 0.3), makeParameter("w", 2.0, 3.0)};
  model.inputs = {makeParameter("amplitude", 0.8, 1.2)};
  return model;
}

std::vector<ParameterSpec> listBox(const ModelSpec& model) {
  std::vector<ParameterSpec> box = model.parameters;
  box.insert(box.end(), model.nuisance.begin(), model.nuisance.end());
  box.insert(box.end(), model.inputs.begin(), model.inputs.end());
  return box;
}

SurrogateTraining trainOn(const ModelSpec& model, Response response, Index count, int threads = 2) {
  return trainSurrogate(model, makeSamples(samplePoints(listBox(model), count, 1), response), {threads});
}

TEST(Surrogate, OfALinearModelGivesTheClosedFormPosterior) {
  const SurrogateTraining trained = trainOn(makeLinearModel(), calcLinear, 100);
  const MatrixXd slopes = calcLinear(MatrixXd::Identity(3, 3));
  // Far from the bounds of a and b the uniform prior says nothing of them; c is that of its box, to the
  // accuracy that a normal prior of its variance stands for it: the features tell c to 0.3 of its box's
  // deviation.
  MatrixXd information = slopes.transpose() * slopes / (kNoise * kNoise);
  information(2, 2) += 3.0;
  const MatrixXd covariance = invert(information);
  const MatrixXd points = (MatrixXd(3, 3) << 2.0, 1.7, 2.3, 0.1, -0.2, 0.3, 0.1, -0.1, 0.0).finished();
  const MatrixXd clean = calcLinear(points);
  const Estimates found = trained.surrogate.predict(clean, MatrixXd(0, 3));
  for (Index j = 0; j < 3; ++j) {
    const VectorXd mean = covariance * (slopes.transpose() * clean.col(j)) / (kNoise * kNoise);
    for (Index k = 0; k < 2; ++k) {
      const double stddev = std::sqrt(covariance(k, k));
      EXPECT_NEAR(found.mean(k, j), mean(k), 0.1 * stddev);
      EXPECT_NEAR(found.stddev(k, j) / trained.surrogate.validation.stddev_scale(k) / stddev, 1.0, 0.1);
    }
  }
}

TEST(Surrogate, CoversTheTruthNearTheLimitOfANonlinearModelWithAKnownInput) {
  const ModelSpec model = makeOscillationModel();
  const SurrogateTraining trained = trainOn(model, calcOscillation, 120);
  EXPECT_EQ(trained.surrogate.validation.status, SurrogateStatus::kOk);
  constexpr Index kTests = 400;
  const MatrixXd points = samplePoints(listBox(model), kTests, 2);
  const Estimates found =
      trained.surrogate.predict(addNoise(calcOscillation(points), 3), points.bottomRows(1), 2);
  const MatrixXd z = (found.mean - points.topRows(2)).cwiseQuotient(found.stddev);
  for (Index k = 0; k < 2; ++k) {
    const double covered = static_cast<double>((z.row(k).array().abs() < 1.96).count()) / kTests;
    EXPECT_NEAR(covered, 0.95, 0.035) << k;  // three standard errors
  }
  constexpr double kStep = 1e-5;  // the limit in the middle of the box
  const VectorXd middle = (VectorXd(3) << 0.2, 2.5, 1.0).finished();
  MatrixXd slopes(kTimes, 2);
  for (Index k = 0; k < 2; ++k) {
    const VectorXd moved = kStep * VectorXd::Unit(3, k);
    slopes.col(k) = (calcOscillation(middle + moved) - calcOscillation(middle - moved)) / (2.0 * kStep);
  }
  const MatrixXd limit = invert(slopes.transpose() * slopes / (kNoise * kNoise));
  const Estimates at = trained.surrogate.predict(calcOscillation(middle), middle.tail(1));
  for (Index k = 0; k < 2; ++k) {
    EXPECT_NEAR(at.stddev(k, 0) / std::sqrt(limit(k, k)), 1.0, 0.25) << k;
  }
}

TEST(Surrogate, StaysWithinTheBoundsWhateverIsMeasured) {
  const SurrogateTraining trained = trainOn(makeLinearModel(), calcLinear, 60);
  const MatrixXd points = (MatrixXd(3, 2) << 3.5, 40.0, 0.9, -30.0, 0.0, 0.0).finished();
  const Estimates found = trained.surrogate.predict(calcLinear(points), MatrixXd(0, 2));
  EXPECT_TRUE(found.mean.allFinite() && found.stddev.allFinite());
  EXPECT_LE(found.mean.row(0).maxCoeff(), 3.0);
  EXPECT_GE(found.mean.row(1).minCoeff(), -1.0);
  EXPECT_GT(found.stddev.minCoeff(), 0.0);
}

/// Of a parameter whose sign nothing shows, and of one that all shows.
MatrixXd calcSquared(const MatrixXd& points) {
  MatrixXd features(kTimes, points.cols());
  for (Index i = 0; i < kTimes; ++i) {
    features.row(i) = std::sin(0.5 * i) * (10.0 * points.row(0)).array().square() +
                      std::cos(0.3 * i) * points.row(1).array();
  }
  return features;
}

TEST(Surrogate, IsNeverLessCertainThanTheBoundsAlone) {
  ModelSpec model;
  model.parameters = {makeParameter("unseen_sign", -0.1, 0.1), makeParameter("seen", -1.0, 1.0)};
  const MatrixXd points = samplePoints(listBox(model), 200, 2);
  const MatrixXd measured = addNoise(calcSquared(points), 3);
  Surrogate surrogate = trainOn(model, calcSquared, 100).surrogate;
  for (const double scale : {1.0, 300.0}) {  // the factor of a surrogate that knows little of its errors
    surrogate.validation.stddev_scale[0] = scale;
    const Estimates found = surrogate.predict(measured, {}, 2);
    const double prior = 0.2 / std::sqrt(12.0);
    EXPECT_NEAR(found.stddev.row(0).maxCoeff(), prior, 1e-12);
    EXPECT_LT(found.stddev.row(1).maxCoeff(), 0.1);
    EXPECT_LE(found.mean.row(0).cwiseAbs().maxCoeff(), 0.1);
    const auto inside =
        (found.mean.row(0) - points.row(0)).cwiseAbs().array() < 1.96 * found.stddev.row(0).array();
    EXPECT_GE(inside.count(), 185) << scale;  // of 200: 95 % less 2 standard errors
  }
}

TEST(Surrogate, DoesNotDependOnTheThreads) {
  const ModelSpec model = makeOscillationModel();
  const SurrogateTraining one = trainOn(model, calcOscillation, 60, 1),
                          three = trainOn(model, calcOscillation, 60, 3);
  EXPECT_TRUE(one.held_out.mean == three.held_out.mean && one.held_out.stddev == three.held_out.stddev);
  const MatrixXd points = samplePoints(listBox(model), 40, 2),
                 features = addNoise(calcOscillation(points), 3);
  const Estimates a = one.surrogate.predict(features, points.bottomRows(1), 1);
  const Estimates b = three.surrogate.predict(features, points.bottomRows(1), 3);
  EXPECT_TRUE(a.mean == b.mean && a.stddev == b.stddev);
}

TEST(Surrogate, RefusesFeaturesWithoutNoiseTooFewSamplesAndMissingInputs) {
  const ModelSpec model = makeOscillationModel();
  SurrogateSamples samples = makeSamples(samplePoints(listBox(model), 60, 1), calcOscillation);
  const SurrogateTraining trained = trainSurrogate(model, samples, {});
  EXPECT_THROW((void)trained.surrogate.predict(samples.measured), std::invalid_argument);
  EXPECT_THROW((void)trained.surrogate.predict(samples.measured.topRows(3), samples.points.bottomRows(1)),
               std::invalid_argument);
  MatrixXd silent = samples.noise_covariance.toMatrix();
  silent(3, 3) = 0.0;
  samples.noise_covariance = silent;
  EXPECT_THROW((void)trainSurrogate(model, samples, {}), std::invalid_argument);
  EXPECT_THROW((void)trainOn(model, calcOscillation, 20), std::invalid_argument);
}

/// Derivatives of the oscillation with respect to damping and stiffness, per width of their bounds, by hand;
/// none at every seventh point.
std::vector<MatrixXd> calcOscillationSlopes(const MatrixXd& points) {
  std::vector<MatrixXd> slopes(static_cast<std::size_t>(points.cols()));
  for (Index j = 0; j < points.cols(); ++j) {
    if (j % 7 == 6) {
      continue;
    }
    MatrixXd& at = slopes[static_cast<std::size_t>(j)];
    at.resize(kTimes, 2);
    for (Index i = 0; i < kTimes; ++i) {
      const double t = 0.25 * static_cast<double>(i + 1);
      const double decayed = points(2, j) * std::exp(-points(0, j) * t);
      at(i, 0) = -t * decayed * std::sin(points(1, j) * t) * 0.2;
      at(i, 1) = t * decayed * std::cos(points(1, j) * t) * 1.0;
    }
  }
  return slopes;
}

/// Root mean square error of the scores of simulations not seen, in standard deviations of the noise.
double measureScores(const ForwardSurrogate& forward, const MatrixXd& points, const MatrixXd& normalized) {
  const MatrixXd scores = forward.calcScores(calcOscillation(points));
  gp::SharedProcess::Workspace workspace;
  double sum = 0.0;
  for (Index j = 0; j < points.cols(); ++j) {
    Index first = 0;
    for (const gp::SharedProcess& process : forward.windows) {
      VectorXd values(process.getFunctionCount());
      process.evaluate(normalized.col(j), values, workspace);
      sum += (values - scores.col(j).segment(first, values.size())).squaredNorm();
      first += values.size();
    }
  }
  return std::sqrt(sum / static_cast<double>(scores.size()));
}

TEST(Surrogate, LearnsFromSlopesWhereSimulationsHaveThem) {
  const ModelSpec model = makeOscillationModel();
  SurrogateSamples samples = makeSamples(samplePoints(listBox(model), 30, 1), calcOscillation);
  const Surrogate without = trainSurrogate(model, samples, {2}).surrogate;
  samples.slopes = calcOscillationSlopes(samples.points);
  const SurrogateTraining one = trainSurrogate(model, samples, {1}),
                          two = trainSurrogate(model, samples, {2});
  EXPECT_TRUE(one.held_out.mean == two.held_out.mean && one.held_out.stddev == two.held_out.stddev);
  const MatrixXd tests = samplePoints(listBox(model), 200, 2);
  const MatrixXd normalized =
      without.half_width.cwiseInverse().asDiagonal() * (tests.colwise() - without.center);
  EXPECT_LT(measureScores(*one.surrogate.forward, tests, normalized),
            0.5 * measureScores(*without.forward, tests, normalized));
}

/// Slopes of the linear features with respect to all three unknowns, per width of their bounds.
std::vector<MatrixXd> makeLinearSlopes(Index count) {
  const MatrixXd per_unit = calcLinear(MatrixXd::Identity(3, 3));
  return std::vector<MatrixXd>(static_cast<std::size_t>(count), 2.0 * per_unit);  // all bounds are 2 apart
}

TEST(PredictedLimit, OfALinearModelIsThatOfItsFisherInformation) {
  const ModelSpec model = makeLinearModel();
  SurrogateSamples samples = makeSamples(samplePoints(listBox(model), 80, 1), calcLinear);
  const SurrogateTraining without = trainSurrogate(model, samples, {2});
  samples.slopes = makeLinearSlopes(80);
  const SurrogateTraining with = trainSurrogate(model, samples, {2});
  const MatrixXd slopes = calcLinear(MatrixXd::Identity(3, 3));  // half-widths are 1
  const MatrixXd limit =
      invert(slopes.transpose() * slopes / (kNoise * kNoise) + 3.0 * MatrixXd::Identity(3, 3));
  const VectorXd point = (VectorXd(3) << 2.0, 0.1, 0.0).finished();
  for (const SurrogateTraining* trained : {&without, &with}) {
    const Estimates found = trained->surrogate.predict(calcLinear(point));
    for (Index k = 0; k < 2; ++k) {
      EXPECT_NEAR(found.limit_stddev(k, 0) / std::sqrt(limit(k, k)), 1.0, 0.02) << k;
      EXPECT_NEAR(trained->surrogate.validation.limit_ratio(k), 1.0, 0.15) << k;
    }
  }
}

TEST(SimulationGain, IsNoneOfALinearModelAndMuchOfAnOscillationFromFewSimulations) {
  const SurrogateTraining linear = trainOn(makeLinearModel(), calcLinear, 100);
  EXPECT_EQ(linear.gain.half, 50);
  EXPECT_EQ(linear.gain.all, 100);
  EXPECT_GT(linear.gain.error_ratio.minCoeff(), 0.9);
  const ModelSpec model = makeOscillationModel();
  const MatrixXd points = samplePoints(listBox(model), 60, 1);
  SurrogateSamples silent = makeSamples(points, calcOscillation);
  silent.noise_covariance =
      1e-6 * silent.noise_covariance.toMatrix();  // a thousandth of the noise: all errors are the surrogate's
  silent.measured = silent.clean_features;
  EXPECT_LT(trainSurrogate(model, silent, {2}).gain.error_ratio.maxCoeff(), 0.7);
}

TEST(SimulationGain, IsUnknownOfTooFewSimulationsToBeHalved) {
  const SurrogateTraining trained = trainOn(makeLinearModel(), calcLinear, 40);
  EXPECT_EQ(trained.gain.half, 0);
  EXPECT_EQ(trained.gain.error_ratio.size(), 0);
}

TEST(SlopePoints, AreAllUntilValuesAndSlopesAreTwoThousand) {
  EXPECT_EQ(countSlopePoints(250, 5), 250);
  EXPECT_EQ(countSlopePoints(1000, 5), 200);
  EXPECT_EQ(countSlopePoints(2500, 5), 0);
  EXPECT_EQ(countSlopePoints(100, 0), 100);  // no unknown, no slopes
  EXPECT_EQ(listFewSlopePoints(250, 8, 218), (std::vector<Eigen::Index>{56, 109}));
  EXPECT_EQ(listFewSlopePoints(1000, 5, 200), (std::vector<Eigen::Index>{50, 100}));
  EXPECT_EQ(listFewSlopePoints(250, 3, 250), (std::vector<Eigen::Index>{150}));
  EXPECT_TRUE(listFewSlopePoints(40, 2, 40).empty());
}

/// Samples of an output at eight times: a smooth function of the points, from some time on a rough one.
WhitenedSamples makeTurning(Index rough_from) {
  WhitenedSamples samples{MatrixXd(2, 120), MatrixXd(8, 120), {}};
  const RandomStream random(1, RandomPurpose::kTrainDesign);
  for (Index j = 0; j < 120; ++j) {
    const double a = 2.0 * random.calcUniform(j, 0) - 1.0, b = 2.0 * random.calcUniform(j, 1) - 1.0;
    samples.points.col(j) << a, b;
    for (Index i = 0; i < 8; ++i) {
      const double rate = i < rough_from ? 1.0 : 40.0;
      samples.features(i, j) = 50.0 * std::sin(rate * a + 0.3 * static_cast<double>(i) * b);
    }
  }
  return samples;
}

TEST(DivideWindow, PartsWhereResponsesBeginToBeUnpredictable) {
  std::vector<FeatureInfo> infos = makeInfos();
  infos.resize(8);
  const FeatureWindow rows = {0, 1, 2, 3, 4, 5, 6, 7};
  const std::vector<WindowChoice> parts = divideWindow(rows, infos, makeTurning(4), nullptr);
  ASSERT_EQ(parts.size(), 2U);
  EXPECT_EQ(parts[0].rows, (FeatureWindow{0, 1, 2, 3}));
  EXPECT_EQ(parts[1].rows, (FeatureWindow{4, 5, 6, 7}));
  EXPECT_LT(parts[0].error, 0.1);
  EXPECT_GT(parts[1].error, 1.0);
  EXPECT_EQ(divideWindow(rows, infos, makeTurning(8), nullptr).size(), 1U);  // smooth throughout
  EXPECT_EQ(divideWindow(rows, infos, makeTurning(0), nullptr).size(), 1U);  // rough throughout
  EXPECT_EQ(divideWindow(rows, {}, makeTurning(4), nullptr).size(), 1U);     // no times
}

TEST(Surrogate, TakesTheErrorOfAWindowForLargeWhereTheMeasurementContradictsIt) {
  const SurrogateTraining trained = trainOn(makeLinearModel(), calcLinear, 100);
  const VectorXd point = (VectorXd(3) << 2.0, 0.1, 0.0).finished();
  MatrixXd features = calcLinear(point);
  const Estimates clean = trained.surrogate.predict(features, MatrixXd(0, 1));
  features.bottomRows(8).array() += 200.0 * kNoise;  // the last of three windows
  const Estimates found = trained.surrogate.predict(features, MatrixXd(0, 1));
  for (Index k = 0; k < 2; ++k) {
    EXPECT_LT(std::abs(found.mean(k, 0) - point(k)), 3.0 * found.stddev(k, 0)) << k;
    EXPECT_GT(found.stddev(k, 0), clean.stddev(k, 0)) << k;
  }
}

}  // namespace
}  // namespace twinmap
