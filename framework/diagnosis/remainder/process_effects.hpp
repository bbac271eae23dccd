#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "framework/diagnosis/recorded_problem.hpp"

namespace twinmap {

/// What a process of unit variance does to the residuals of one recording.
struct ProcessEffect {
  std::string what, unit;
  Eigen::VectorXd knots;      ///< k, s
  Eigen::MatrixXd responses;  ///< n x k, of each knot's value
};

/// Of the forces on all coordinates that take one, and of the errors of all outputs. infos: n, of the
/// recording's features; point: its own unknown parameters. Cost: a simulation with 40 derivatives for each
/// coordinate.
std::vector<ProcessEffect> listProcessEffects(const ExperimentSpec& experiment,
                                              const RecordedFeatures& recording, const Eigen::VectorXd& point,
                                              const std::vector<FeatureInfo>& infos);

}  // namespace twinmap
