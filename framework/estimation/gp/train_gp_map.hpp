#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "framework/data/features/labelled_features.hpp"
#include "framework/estimation/estimate.hpp"
#include "framework/estimation/gp/gp_map.hpp"
#include "framework/estimation/run_tasks.hpp"
#include "framework/experiment/experiment_spec.hpp"
#include "kernels/gp/training.hpp"

namespace twinmap {

/// A trained map and what a person should know about the training.
struct GpMapTraining {
  GpMap map;
  std::vector<gp::TrainingReport> reports;  ///< one per parameter; of a sparse process, that of its subset
  std::vector<std::string> warnings;        ///< "parameter 'd_y': ..."; empty if every process converged
  Estimates leave_one_out;  ///< of each training sample without itself and its replicates (predictLeftOut)
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
/// Throws std::runtime_error naming the parameter whose process cannot be trained. Throws gp::Stopped where
/// the control asks for it, once what is under way is done: the longest is one evaluation of the likelihood
/// with its gradient, n^3 flops of an exact process (1 s at n = 4000 on two cores), 5 n m^2 of a sparse one.
GpMapTraining trainGpMap(const GpMapSpec& spec, const std::vector<TransformStepSpec>& transform,
                         const std::vector<std::string>& parameter_names, const LabelledFeatures& samples,
                         const TrainingControl& control, const std::vector<ParameterSpec>& known_inputs = {});

/// The map that trainGpMap() makes of the same samples where its search ends at the hyperparameters (and
/// inducing inputs) of `trained`: transform, processes, residual correlation and leave-one-out predictions,
/// bit for bit, without the search and its reports. Cost: n^3 / 3 flops per exact process, 2 n m^2 per sparse
/// one, and those of predictLeftOut(). Throws std::runtime_error or std::invalid_argument where the
/// hyperparameters do not fit the samples.
GpMapTraining refitGpMap(const GpMap& trained, const GpMapSpec& spec,
                         const std::vector<TransformStepSpec>& transform, const LabelledFeatures& samples,
                         int threads, const std::vector<ParameterSpec>& known_inputs = {});

}  // namespace twinmap
