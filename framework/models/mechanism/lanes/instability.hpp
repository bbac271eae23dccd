#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "framework/models/mechanism/model_context.hpp"

namespace twinmap {

/// What makes a motion about an equilibrium grow: a force that rises with the coordinate, one that rises with
/// its speed, or neither, as where coordinates or states drive each other.
enum class GrowthCause { kStiffness, kDamping, kCoupling };

/// The motion that grows fastest.
struct Instability {
  double rate = 0.0;            ///< 1/s, of its logarithm
  Eigen::Index coordinate = 0;  ///< that moves most in it
  GrowthCause cause = GrowthCause::kCoupling;
};

/// Of x' = A x for x = [coordinates; their rates; states] (LaneModes::calcMatrix): an eigenvalue whose real
/// part is above what rounding makes of 0, and with z, the coordinates' part of its vector, of
/// lambda^2 z = S z + lambda D z what is positive, z' S z or z' D z. None where all decays or A is not
/// finite.
std::optional<Instability> findInstability(const Eigen::MatrixXd& matrix, Eigen::Index coordinates);

/// "x grows e-fold in 0.16 s, as a force rises with it; look at the sign of cart.yaml:9:3:
/// system.springs[0].stiffness": springs or dampers below 0, else force laws on the coordinate, else gravity.
/// The context's numbers must be those of the equilibrium.
std::string describeInstability(const Instability& instability, ModelContext& context);

}  // namespace twinmap
