#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/data/noise/feature_noise.hpp"
#include "framework/data/sensitivity/feature_sensitivities.hpp"
#include "framework/experiment/model/model_spec.hpp"

namespace twinmap {

/// The best that any estimator can do with the features of each test sample.
struct InformationLimit {
  Eigen::MatrixXd stddev;            ///< p x n, in the parameter's unit; NaN where a simulation failed
  Eigen::MatrixXd mean_information;  ///< p x p: mean Fisher information, marginal, per width of the bounds
  Eigen::MatrixXd mean_covariance;   ///< p x p: mean of the limit's covariances, in widths
  /// d x p: root mean square over the samples of the change of a feature per width of a parameter's bounds,
  /// in standard deviations of the feature's noise.
  Eigen::MatrixXd relevance;
  /// n: of each sample the Fisher information (p x p), marginal, per width; empty where its simulation
  /// failed.
  std::vector<Eigen::MatrixXd> information{};
  int failures = 0;  ///< samples without a limit
  /// n: what is known of the parameters before a measurement (p x p, per width), the others marginalised;
  /// empty where all are uniform within their bounds.
  std::vector<Eigen::MatrixXd> prior{};

  /// The limit's covariance (p x p, in widths) of a sample that has one.
  Eigen::MatrixXd calcCovariance(std::size_t sample) const;
  /// Mean over the samples of the prior's covariance (p x p, in widths).
  Eigen::MatrixXd calcPriorCovariance() const;
};

/// Per sample: sensitivities J of the features to the unknown and covariance C of their noise there give the
/// covariance (J' C^-1 J + 12 / width^2)^-1, the box entering as a prior of its variance. `parameters` (p)
/// are the first of the unknown, those to be inferred; the others are marginalised (calcMarginalInformation).
/// prior: in place of the box, of all unknown at each sample (Prior::calcInformation), unless it is empty.
/// Throws std::invalid_argument for a feature without noise, std::runtime_error if every sample failed.
InformationLimit calcInformationLimit(const std::vector<LocalModel>& models, const FeatureNoise& noise,
                                      const std::vector<ParameterSpec>& parameters,
                                      const std::vector<Eigen::MatrixXd>& prior = {});

}  // namespace twinmap
