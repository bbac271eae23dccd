#pragma once

#include <Eigen/Core>
#include <cmath>

#include "framework/base/random/random.hpp"
#include "framework/estimation/gp/online_processes.hpp"
#include "framework/estimation/gp/train_gp_map.hpp"
#include "framework/estimation/surrogate/fit_forward.hpp"
#include "framework/estimation/trained/fit_trust.hpp"

namespace twinmap::testing {

/// A decaying oscillation exp(-d t) cos(w t), sampled at 60 times up to 6 s with white noise: the features
/// are the samples. d in [0.1, 0.3] 1/s, w in [2, 3] rad/s.
struct Oscillation {
  static constexpr double kNoise = 0.01;
  static constexpr int kSamples = 60;

  std::vector<ParameterSpec> parameters{makeParameter("d", 0.1, 0.3), makeParameter("w", 2.0, 3.0)};

  static ParameterSpec makeParameter(const char* name, double lower, double upper) {
    ParameterSpec parameter;
    parameter.name.text = name;
    parameter.bounds = {lower, upper, {}};
    return parameter;
  }

  static Eigen::VectorXd calcClean(double d, double w) {
    return Eigen::VectorXd::NullaryExpr(kSamples, [=](Eigen::Index i) {
      const double t = 0.1 * static_cast<double>(i + 1);
      return std::exp(-d * t) * std::cos(w * t);
    });
  }

  /// n points of the box.
  static Eigen::MatrixXd samplePoints(int n, std::uint64_t seed) {
    const RandomStream random(seed, RandomPurpose::kTrainDesign);
    Eigen::MatrixXd points(2, n);
    for (int i = 0; i < n; ++i) {
      points.col(i) << 0.1 + 0.2 * random.calcUniform(i, 0), 2.0 + random.calcUniform(i, 1);
    }
    return points;
  }

  static Eigen::MatrixXd calcClean(const Eigen::MatrixXd& points) {
    Eigen::MatrixXd features(kSamples, points.cols());
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
      features.col(i) = calcClean(points(0, i), points(1, i));
    }
    return features;
  }

  static Eigen::MatrixXd addNoise(Eigen::MatrixXd features, std::uint64_t seed) {
    const RandomStream random(seed, RandomPurpose::kTestNoise);
    for (Eigen::Index i = 0; i < features.cols(); ++i) {
      for (Eigen::Index j = 0; j < features.rows(); ++j) {
        features(j, i) += kNoise * random.calcNormal(i, j);
      }
    }
    return features;
  }

  static Eigen::MatrixXd getNoiseCovariance() {
    return kNoise * kNoise * Eigen::MatrixXd::Identity(kSamples, kSamples);
  }

  static std::vector<FeatureInfo> makeInfos() {
    std::vector<FeatureInfo> infos;
    for (int i = 0; i < kSamples; ++i) {
      infos.push_back({"y(" + std::to_string(i) + ")", "m", 0, 0.1 * (i + 1)});
    }
    return infos;
  }

  GpMap trainMap(int n = 150) const {
    LabelledFeatures samples;
    samples.infos = makeInfos();
    samples.parameters = samplePoints(n, 1);
    samples.features = addNoise(calcClean(samples.parameters), 1);
    samples.noise_covariance = getNoiseCovariance();
    const std::vector<TransformStepSpec> transform{{WhitenSpec{}, {}}, {PrincipalComponentsSpec{}, {}}};
    return trainGpMap({}, transform, {"d", "w"}, samples, {1}).map;
  }

  /// Of the training simulations.
  static ForwardSurrogate fitSurrogate(const TrustTraining& training) {
    Eigen::MatrixXd normalized = training.points;
    normalized.row(0).array() = (normalized.row(0).array() - 0.2) / 0.1;
    normalized.row(1).array() = (normalized.row(1).array() - 2.5) / 0.5;
    return fitForward({training.infos, normalized, training.clean_features, training.noise_covariance}, {},
                      {})
        .surrogate;
  }

  TrustTraining makeTrustTraining() const {
    TrustTraining training;
    training.sampled = parameters;
    training.prior = makeUniformPrior(2);
    training.infos = makeInfos();
    training.points = samplePoints(150, 1);
    training.clean_features = calcClean(training.points);
    training.noise_covariance = getNoiseCovariance();
    training.measured = addNoise(calcClean(samplePoints(1500, 2)), 2);
    training.known.resize(0, 1500);
    return training;
  }
};

}  // namespace twinmap::testing
