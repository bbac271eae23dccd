#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "framework/diagnosis/candidates/observed_motion.hpp"
#include "framework/diagnosis/problem/recorded_problem.hpp"

namespace twinmap {

/// What a process of unit variance does to the residuals of recordings.
struct ProcessEffect {
  std::string what, unit;
  Eigen::VectorXd knots;      ///< k, s or what else the process is a function of
  Eigen::MatrixXd responses;  ///< n x k, of each knot's value
};

/// Of a force on a coordinate that is a function of a `quantity` ("t", "x", "x_dot"), linear between
/// equidistant knots and 0 beyond them. point: of all unknown parameters. Throws std::runtime_error where
/// that cannot be simulated. Cost: a simulation with 40 derivatives a recording and 40 knots.
ProcessEffect calcForceEffect(const ExperimentSpec& experiment, const RecordedFeatures& recordings,
                              const Eigen::VectorXd& point, const ForcedCoordinate& coordinate,
                              const std::string& quantity, const Eigen::VectorXd& knots);

/// The same of a single force (n), by its expression.
Eigen::VectorXd calcForceEffect(const ExperimentSpec& experiment, const RecordedFeatures& recordings,
                                const Eigen::VectorXd& point, const ForcedCoordinate& coordinate,
                                const Expression& force);

/// Of the forces on all coordinates that take one, and of the errors of all outputs. infos: n, of the
/// recording's features; point: its own unknown parameters. Cost: a simulation with 40 derivatives for each
/// coordinate.
std::vector<ProcessEffect> listProcessEffects(const ExperimentSpec& experiment,
                                              const RecordedFeatures& recording, const Eigen::VectorXd& point,
                                              const std::vector<FeatureInfo>& infos);

}  // namespace twinmap
