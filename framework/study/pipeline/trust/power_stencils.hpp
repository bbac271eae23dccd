#pragma once

#include <vector>

#include "framework/data/features/feature_extractor.hpp"
#include "framework/estimation/trained/online_model.hpp"
#include "framework/study/pipeline/preparation/simulated_sets.hpp"

namespace twinmap {

/// The constants whose values are numbers other than zero, as parameters 20 % around them; of a model from
/// elsewhere those that it knows.
std::vector<ParameterSpec> listConstants(const ModelSpec& model);

/// A test sample around which the features are linear.
struct Stencil {
  Eigen::VectorXd features, known;
  Eigen::MatrixXd sensitivities;  ///< d x u, per half-width of the unknown parameters
  Eigen::MatrixXd slopes;         ///< d x c, per relative change of the constants
  Eigen::VectorXd response;
};

/// The first test samples, 10 or as many as may be simulated; without those whose derivatives cannot be.
/// Cost: 10 simulations with derivatives along the unknown parameters and the constants, and as many points
/// fewer, at least one, as differences of simulations would cost more than a fifth of the run's samples.
std::vector<Stencil> simulateStencils(const Study& study, const SimulatedSets& sets,
                                      const std::vector<ParameterSpec>& constants);

}  // namespace twinmap
