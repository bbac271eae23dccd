#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/estimation/estimate.hpp"
#include "framework/estimation/known_inputs.hpp"
#include "framework/estimation/surrogate/surrogate.hpp"
#include "kernels/network/ensemble.hpp"

namespace twinmap {

/// What a network sees of a measurement: projection (features - center), of at most unit variance over the
/// training samples, above the scaled known inputs. The projection's numbers are rounded as an online map's
/// are (linalg::roundToHalves): less than the last digits of a sensor.
struct NetworkInputs {
  Eigen::VectorXd center;      ///< d
  Eigen::MatrixXd projection;  ///< k x d
  KnownInputs known;           ///< q

  Eigen::Index countInputs() const { return projection.rows() + known.center.size(); }
  /// Features (d x n) and known inputs (q x n) -> k + q x n.
  Eigen::MatrixXd apply(const Eigen::MatrixXd& features, const Eigen::MatrixXd& known_values) const;
};

/// A map from features to parameters by a neural network, whose targets are the parameters on [-1, 1] of
/// their bounds. A trained, immutable value.
struct NetworkMap {
  NetworkInputs inputs;
  Eigen::VectorXd center, half_width;    ///< p, of the parameters' bounds
  std::vector<network::Member> members;  ///< one, or several whose answers are as likely as each other
  SurrogateValidation
      validation;  ///< of simulations that took no part; no limit_scale, limit_ratio may be NaN

  /// Features (d x n, finite) and known inputs (q x n) -> mean and standard deviation of the parameters (p x
  /// n), with the correlations of each column. The result does not depend on the threads. Throws
  /// std::invalid_argument for sizes that do not fit. Cost: some us a column.
  Estimates predict(const Eigen::MatrixXd& features, const Eigen::MatrixXd& known_values,
                    int threads = 1) const;

  /// Of the targets to the parameters, standard deviations multiplied (p), answers no wider than the bounds.
  Estimates convertTargets(Estimates predictions, const Eigen::VectorXd& stddev_scale) const;

  /// Normal distributions of an answer, of which a mixture has several.
  Eigen::Index countComponents() const { return members.front().network.countComponents(); }
  /// Whether weights are known by a distribution.
  bool isBayesian() const { return members.size() > 1 || members.front().last_layer.size() > 0; }
};

/// What a network of several components has predicted, in its targets' units.
Mixture takeMixture(const network::Predictor::Workspace& predicted);

/// Mean, standard deviation (p x n), correlations and, of several components, mixtures of the targets of
/// networks for their inputs (k x n).
Estimates predictTargets(const std::vector<network::Member>& members, const Eigen::MatrixXd& inputs,
                         int threads);

}  // namespace twinmap
