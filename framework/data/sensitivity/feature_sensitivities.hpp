#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/data/features/feature_extractor.hpp"
#include "framework/experiment/model/model_spec.hpp"
#include "framework/simulation/simulator.hpp"

namespace twinmap {

/// The clean response and features of one parameter point, and the features' derivatives there.
struct LocalModel {
  Eigen::VectorXd response;  ///< rows of the layout
  Eigen::VectorXd features;  ///< d
  /// d x p: change of each feature per width (upper - lower) of the parameter's bounds.
  Eigen::MatrixXd sensitivities;
  SampleStatus status;  ///< if not ok, the rest is NaN
};

/// From the responses of the point's stencil (StencilSimulator), one column.
LocalModel makeLocalModel(const FeatureExtractor& extractor, const std::vector<ParameterSpec>& parameters,
                          const Eigen::VectorXd& point, const Eigen::Ref<const Eigen::VectorXd>& stencil,
                          const SampleStatus& status);

/// At points of the sampled box (columns), to `parameters`, the first p of it (such as collectUnknown; the
/// known inputs behind them stay). With the exact derivatives of the responses where the simulator has them,
/// along which features are differenced; else by differences of simulations that all take the integration
/// steps of each point itself (Simulator::simulateAround), so that a step of 1e-4 of the bounds' width holds
/// more than 4 digits: central ones, one-sided ones of second order where the step would leave the bounds. A
/// point fails if one of its simulations does, or if a feature is missing. The result does not depend on the
/// number of threads. Cost: for each, one simulation with derivatives, or 2 p + 1 simulations.
std::vector<LocalModel> calcLocalModels(const Simulator& prototype, const FeatureExtractor& extractor,
                                        const std::vector<ParameterSpec>& parameters,
                                        const Eigen::MatrixXd& points, int threads);

}  // namespace twinmap
