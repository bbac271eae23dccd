#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "framework/features/feature_transform.hpp"
#include "framework/features/labelled_features.hpp"
#include "framework/inverse_map/known_inputs.hpp"
#include "framework/inverse_map/noise_profile.hpp"
#include "framework/inverse_map/predictions.hpp"
#include "framework/inverse_map/process.hpp"
#include "framework/spec/experiment_spec.hpp"
#include "kernels/gp/training.hpp"

namespace twinmap {

/// An inverse map: features and known inputs -> parameters with standard deviation, by one Gaussian process
/// per parameter on the standardised parameter (p - offset) / scale. The inputs of the processes are the
/// transformed features, then the scaled known inputs. A fitted, immutable value.
struct GpMap {
  FeatureTransform transform;
  Eigen::VectorXd target_offset;   ///< p, mean of the training parameters
  Eigen::VectorXd target_scale;    ///< p, their standard deviation
  std::vector<Process> processes;  ///< one per parameter; exact ones share their training inputs
  /// R (p x p), of the errors among the parameters, estimated from the training samples left out
  /// (calcResidualCorrelation): the joint predictive covariance of a sample is D R D, D = diag(stddev).
  Eigen::MatrixXd residual_correlation;
  NoiseProfile noise;
  KnownInputs known_inputs;

  /// What the processes see of features (d x m, untransformed) and known inputs (q x m): k + q x m.
  Eigen::MatrixXd makeProcessInputs(const Eigen::MatrixXd& features, const Eigen::MatrixXd& inputs) const;

  /// Features (d x m, untransformed) and known inputs (q x m, an empty matrix where there are none, else
  /// std::invalid_argument) ->
  /// predictions (p x m each). The standard deviation is the predictive
  /// one, noise included: the spread of the parameter given the features.
  Predictions predict(const Eigen::MatrixXd& features, const Eigen::MatrixXd& inputs = {}) const;
};

/// A trained map and what a person should know about the training.
struct GpMapTraining {
  GpMap map;
  std::vector<gp::TrainingReport> reports;  ///< one per parameter; of a sparse process, that of its subset
  std::vector<std::string> warnings;        ///< "parameter 'd_y': ..."; empty if every process converged
  Predictions leave_one_out;  ///< of each training sample without itself and its replicates (predictLeftOut)
};

/// Draws of the noise, at least one, that the hyperparameters of exact processes are searched with: those
/// that stay within 2000 columns. A search costs some 90 times as much as the final fit.
int countSearchedReplicates(Eigen::Index columns, int replicates);

/// Trains the map on features, parameters and known inputs of the same samples, n >= 2; `known_inputs`: the
/// inputs' bounds.
///
/// Replicates share their parameters exactly, and the marginal likelihood knows nothing of that: its best
/// optimum may recognise the simulation instead of inferring the parameter. So the hyperparameters are found
/// on the first draw, and only the optimum that leads to is followed with all draws; for exact processes with
/// no more of them than countSearchedReplicates(). The processes are fitted to all draws.
///
/// The result does not depend on `threads`. Throws std::runtime_error naming the parameter whose process
/// cannot be trained.
GpMapTraining trainGpMap(const GpMapSpec& spec, const std::vector<TransformStepSpec>& transform,
                         const std::vector<std::string>& parameter_names, const LabelledFeatures& samples,
                         int threads, const std::vector<ParameterSpec>& known_inputs = {});

/// The map that trainGpMap() makes of the same samples where its search ends at the hyperparameters (and
/// inducing inputs) of `trained`: transform, processes, residual correlation and leave-one-out predictions,
/// bit for bit, without the search and its reports. Cost: n^3 / 3 flops per exact process, 2 n m^2 per sparse
/// one, and those of predictLeftOut(). Throws std::runtime_error or std::invalid_argument where the
/// hyperparameters do not fit the samples.
GpMapTraining refitGpMap(const GpMap& trained, const GpMapSpec& spec,
                         const std::vector<TransformStepSpec>& transform, const LabelledFeatures& samples,
                         int threads, const std::vector<ParameterSpec>& known_inputs = {});

}  // namespace twinmap
