#include "framework/estimation/network/network_map.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "framework/data/noise/feature_noise.hpp"
#include "framework/estimation/network/train_network_map.hpp"
#include "framework/estimation/surrogate/train_surrogate.hpp"
#include "tests/framework/estimation/network/small_networks.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kTimes = 24;

/// A decaying oscillation of damping d and frequency w, its amplitude known.
struct Oscillation {
  ModelSpec model;
  std::vector<FeatureSpec> features{SamplesFeatureSpec{{{"y", {}}}, 0.25, 0.25, kTimes}};
  ResponseLayout layout{{"y"}, {"m"}, collectTimes(features)};
  FeatureExtractor extractor{features, layout};
  ResponseNoise noise{VectorXd::Constant(kTimes, kNoise)};

  Oscillation() {
    model.parameters = {makeParameter("d", 0.1, 0.3), makeParameter("w", 2.0, 3.0)};
    model.inputs = {makeParameter("amplitude", 0.8, 1.2)};
  }

  static MatrixXd samplePoints(Index count, std::uint64_t seed) {
    const RandomStream random(seed, RandomPurpose::kTrainDesign);
    MatrixXd points(3, count);
    for (Index j = 0; j < count; ++j) {
      points.col(j) << 0.1 + 0.2 * random.calcUniform(j, 0), 2.0 + random.calcUniform(j, 1),
          0.8 + 0.4 * random.calcUniform(j, 2);
    }
    return points;
  }

  MatrixXd respond(const MatrixXd& points) const {
    return MatrixXd::NullaryExpr(kTimes, points.cols(), [&](Index i, Index j) {
      const double t = layout.times[i];
      return points(2, j) * std::exp(-points(0, j) * t) * std::sin(points(1, j) * t);
    });
  }

  MatrixXd measure(const MatrixXd& points, std::uint64_t seed) const {
    return extractor.extract(noise.add(respond(points), {seed, RandomPurpose::kTestNoise}, 0));
  }

  /// Standard deviations that the noise allows at a point, the amplitude known.
  static Eigen::Vector2d calcLimit(const VectorXd& point) {
    MatrixXd slopes(kTimes, 2);
    for (Index i = 0; i < kTimes; ++i) {
      const double t = 0.25 * static_cast<double>(i + 1), envelope = point[2] * t * std::exp(-point[0] * t);
      slopes.row(i) << -envelope * std::sin(point[1] * t), envelope * std::cos(point[1] * t);
    }
    const Eigen::Matrix2d information = slopes.transpose() * slopes / (kNoise * kNoise);
    const double determinant = information(0, 0) * information(1, 1) - information(0, 1) * information(1, 0);
    return {std::sqrt(information(1, 1) / determinant), std::sqrt(information(0, 0) / determinant)};
  }
};

const MatrixXd& getNoiseCovariance() {
  static const MatrixXd covariance = kNoise * kNoise * MatrixXd::Identity(kTimes, kTimes);
  return covariance;
}

/// A transform that only divides features by their noise.
FeatureTransform makeWhitening() {
  return {{AffineStep{VectorXd::Zero(kTimes), VectorXd::Constant(kTimes, kNoise), {}}}};
}

NetworkMapTraining trainOnSimulations(const Oscillation& oscillation, Index count, const NetworkMapSpec& spec,
                                      int threads = 2) {
  const MatrixXd points = Oscillation::samplePoints(count, 1), responses = oscillation.respond(points);
  const FeatureTransform transform = makeWhitening();
  return trainNetworkMap(
      {oscillation.model, spec, 3},
      {points, responses, oscillation.extractor, oscillation.noise, transform, true, getNoiseCovariance()},
      {threads});
}

NetworkMapTraining trainOnSimulations(const Oscillation& oscillation, Index count, int steps,
                                      int threads = 2) {
  return trainOnSimulations(oscillation, count, makeSpec(steps), threads);
}

SurrogateTraining trainTeacher(const Oscillation& oscillation) {
  const MatrixXd points = Oscillation::samplePoints(120, 1);
  return trainSurrogate(
      oscillation.model,
      {oscillation.extractor.getInfos(), points, oscillation.extractor.extract(oscillation.respond(points)),
       getNoiseCovariance(), oscillation.measure(points, 5)},
      {2});
}

NetworkMapTraining trainOnPool(const Oscillation& oscillation, const SurrogateTraining& teacher,
                               const NetworkMapSpec& spec, int threads) {
  const SurrogatePool pool =
      makeSurrogatePool(teacher.surrogate, oscillation.model, spec.surrogate_samples, 3, {threads});
  return trainNetworkMap({oscillation.model, spec, 3}, pool, {threads});
}

/// Of unseen measurements; most_of_limit: of errors over what the noise allows.
void expectCalibratedAndNearTheLimit(const Oscillation& oscillation, const NetworkMap& map,
                                     double most_of_limit = 2.0) {
  constexpr Index kTests = 600;
  const MatrixXd points = Oscillation::samplePoints(kTests, 2);
  const Estimates found = map.predict(oscillation.measure(points, 3), points.bottomRows(1), 2);
  MatrixXd limit(2, kTests);
  for (Index i = 0; i < kTests; ++i) {
    limit.col(i) = Oscillation::calcLimit(points.col(i));
  }
  const MatrixXd errors = found.mean - points.topRows(2);
  for (Index k = 0; k < 2; ++k) {
    const double covered =
        (errors.row(k).array().abs() < kNormal95 * found.stddev.row(k).array()).cast<double>().mean();
    EXPECT_GT(covered, 0.91);
    EXPECT_LT(covered, 0.99);
    EXPECT_LT(errors.row(k).norm(), most_of_limit * limit.row(k).norm());
  }
}

TEST(NetworkMap, LearnsFromSimulationsAndTellsItsErrors) {
  const Oscillation oscillation;
  expectCalibratedAndNearTheLimit(oscillation, trainOnSimulations(oscillation, 2000, 700).map);
}

TEST(NetworkMap, LearnsFromASurrogateOfFewSimulations) {
  const Oscillation oscillation;
  const SurrogateTraining teacher = trainTeacher(oscillation);
  NetworkMapSpec spec = makeSpec(600);
  spec.surrogate_samples = 3000;
  const NetworkMapTraining trained = trainOnPool(oscillation, teacher, spec, 2);
  expectCalibratedAndNearTheLimit(oscillation, trained.map);
}

TEST(NetworkMap, MakesUpForErrorsOfItsTeacherWhoseShapeIsNotToBlame) {
  const Oscillation oscillation;
  const SurrogateTraining teacher = trainTeacher(oscillation);
  NetworkMapSpec spec = makeSpec(200);
  spec.surrogate_samples = 5000;
  SurrogatePool pool =
      makeSurrogatePool(teacher.surrogate, oscillation.model, spec.surrogate_samples, 3, {2});
  const NetworkMapTraining calibrated = trainNetworkMap({oscillation.model, spec, 3}, pool, {2});
  pool.left_out.factor *= 2.0;  // as if the teacher left out most of what is in a measurement
  const NetworkMapTraining taught = trainNetworkMap({oscillation.model, spec, 3}, pool, {2});
  for (Index k = 0; k < 2; ++k) {
    EXPECT_NEAR(calibrated.map.validation.stddev_scale[k], 1.0, 0.1);
    EXPECT_NEAR(taught.map.validation.stddev_scale[k], 2.0, 0.2);
  }
  EXPECT_TRUE(taught.warnings.empty()) << taught.warnings.front();
}

TEST(SurrogatePool, HasTheSimulationsAsWrongAsTheSurrogateIsWithoutThem) {
  const Oscillation oscillation;
  const SurrogateTraining teacher = trainTeacher(oscillation);
  const SurrogatePool pool = makeSurrogatePool(teacher.surrogate, oscillation.model, 1000, 3, {2});
  const ForwardSurrogate& forward = *teacher.surrogate.forward;
  ASSERT_EQ(pool.left_out_points.cols(), 120);
  const MatrixXd clean = oscillation.extractor.extract(oscillation.respond(pool.left_out_points));
  const MatrixXd error =
      pool.left_out.clean.topRows(pool.projection.rows()) - pool.projection * (clean.colwise() - pool.center);
  const MatrixXd errors_of_scores =
      pool.inputs.error_projection * forward.error_variance.cwiseSqrt().asDiagonal();
  const double expected = errors_of_scores.squaredNorm();  // were they independent
  EXPECT_GT(error.colwise().squaredNorm().mean(), 0.3 * expected);
  EXPECT_LT(error.colwise().squaredNorm().mean(), 3.0 * expected);
  const MatrixXd known = pool.left_out.clean.bottomRows(1);
  EXPECT_LT((known - (pool.left_out_points.bottomRows(1).array() - 1.0).matrix() / 0.2).norm(), 1e-12);
}

TEST(NetworkMap, OfFewSimulationsIsToldByOthersThatItIsOverconfident) {
  const NetworkMapTraining trained = trainOnSimulations(Oscillation(), 60, 300);
  EXPECT_GT(trained.map.validation.stddev_scale.maxCoeff(), 1.1);
  const MatrixXd standardised =
      (trained.held_out.mean - trained.held_out_truth).cwiseQuotient(trained.held_out.stddev);
  EXPECT_GT((standardised.array().abs() < kNormal95).cast<double>().mean(), 0.93);
}

TEST(NetworkMap, IsTheSameForAnyNumberOfThreads) {
  const Oscillation oscillation;
  const NetworkMapTraining one = trainOnSimulations(oscillation, 200, 60, 1);
  const NetworkMapTraining three = trainOnSimulations(oscillation, 200, 60, 3);
  for (std::size_t i = 0; i < one.map.members.front().network.layers.size(); ++i) {
    EXPECT_EQ(one.map.members.front().network.layers[i].weights,
              three.map.members.front().network.layers[i].weights);
  }
  EXPECT_EQ(one.map.validation.stddev_scale, three.map.validation.stddev_scale);
  const SurrogateTraining teacher = trainTeacher(oscillation);
  NetworkMapSpec spec = makeSpec(60);
  spec.surrogate_samples = 1000;
  EXPECT_EQ(trainOnPool(oscillation, teacher, spec, 1).map.members.front().network.skip,
            trainOnPool(oscillation, teacher, spec, 3).map.members.front().network.skip);
}

TEST(NetworkMap, IsTrainedOftenEnoughToTellHowCalibratedItIs) {
  const NetworkMapSpec plain;
  NetworkMapSpec several;
  several.bayesian = NetworkBayes::kLastLayer;
  EXPECT_EQ(countTrainings(plain, 100), 11);
  EXPECT_EQ(countTrainings(several, 100), 6);
  EXPECT_EQ(countTrainings(plain, 2000), 11);
  EXPECT_EQ(countTrainings(plain, 2001), 1);
  EXPECT_EQ(countTrainings(several, 2001), 1);
}

TEST(NetworkMap, OfAnEnsembleIsCalibratedAndTheSameForAnyNumberOfThreads) {
  const Oscillation oscillation;
  NetworkMapSpec spec = makeSpec(300);
  spec.bayesian = NetworkBayes::kLastLayer;
  const NetworkMapTraining one = trainOnSimulations(oscillation, 300, spec, 1);
  ASSERT_EQ(one.map.members.size(), 5U);
  EXPECT_NE(one.map.members[0].network.skip, one.map.members[1].network.skip);
  EXPECT_EQ(one.map.members[0].last_layer.rows(), 2 * (24 + 1));
  expectCalibratedAndNearTheLimit(oscillation, one.map, 3.5);
  const NetworkMapTraining three = trainOnSimulations(oscillation, 300, spec, 3);
  for (std::size_t i = 0; i < one.map.members.size(); ++i) {
    EXPECT_EQ(one.map.members[i].last_layer, three.map.members[i].last_layer);
  }
}

TEST(NetworkMap, OfSampledWeightsIsCalibratedAndSaysHowWellItKnowsThem) {
  const Oscillation oscillation;
  NetworkMapSpec spec = makeSpec(300);
  spec.hidden = {3};
  spec.bayesian = NetworkBayes::kHamiltonian;
  spec.chains = 2;
  spec.draws = 30;
  const NetworkMapTraining trained = trainOnSimulations(oscillation, 60, spec);
  ASSERT_EQ(trained.map.members.size(), 2U * 30U);
  ASSERT_TRUE(trained.chains);
  EXPECT_EQ(trained.chains->chains, 2);
  EXPECT_EQ(trained.chains->draws, 30);
  ASSERT_EQ(trained.chains->means.size(), 2U);
  EXPECT_GT(trained.chains->means[0].effective_sample_size, 1.0);
  EXPECT_GE(trained.chains->means[0].r_hat, 0.99);
  // so few draws cannot know the posterior, which is said
  ASSERT_FALSE(trained.warnings.empty());
  EXPECT_NE(trained.warnings.front().find("have not converged"), std::string::npos);
  const MatrixXd points = Oscillation::samplePoints(200, 2);
  const Estimates found = trained.map.predict(oscillation.measure(points, 9), MatrixXd(points.bottomRows(1)));
  const MatrixXd z = (found.mean - points.topRows(2)).cwiseQuotient(found.stddev);
  EXPECT_NEAR((z.array().abs() < 1.96).cast<double>().mean(), 0.95, 0.06);
}

TEST(NetworkMap, RefusesTooFewSimulationsAndOtherSizes) {
  const Oscillation oscillation;
  EXPECT_THROW(trainOnSimulations(oscillation, 40, 10), std::invalid_argument);
  const NetworkMap map = trainOnSimulations(oscillation, 60, 10).map;
  EXPECT_THROW(map.predict(MatrixXd::Zero(kTimes - 1, 1), MatrixXd::Zero(1, 1)), std::invalid_argument);
  EXPECT_THROW(map.predict(MatrixXd::Zero(kTimes, 2), MatrixXd::Zero(1, 1)), std::invalid_argument);
  EXPECT_THROW(map.predict(MatrixXd::Zero(kTimes, 1), MatrixXd()), std::invalid_argument);
}

}  // namespace
}  // namespace twinmap
