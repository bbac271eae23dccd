#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "framework/experiment/model/model_spec.hpp"

namespace twinmap {

/// Samples of a simulation that shows how a machine moves: some tens in the shortest period that matters.
constexpr Eigen::Index kMotionSamples = 1001;

/// A coordinate on which forces may act.
struct ForcedCoordinate {
  std::string name;
  bool is_angle = false;

  const char* getForceUnit() const { return is_angle ? "N m" : "N"; }
  const char* getUnit() const { return is_angle ? "rad" : "m"; }
};

/// In the order of the bodies.
std::vector<ForcedCoordinate> listForcedCoordinates(const SystemSpec& system);

/// A coordinate, then its speed, as outputs.
void observeMotion(const ForcedCoordinate& coordinate, std::vector<OutputSpec>& outputs);

/// A force as an output, by its expression.
void observeForce(const std::string& name, const Expression& force, std::vector<OutputSpec>& outputs);

/// The outputs of a model at times (times x outputs). point: of the sampled box. Throws std::runtime_error
/// where that cannot be simulated.
Eigen::MatrixXd simulateOutputs(const ModelSpec& model, const Eigen::VectorXd& times,
                                const Eigen::VectorXd& point);

}  // namespace twinmap
