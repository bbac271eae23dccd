#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "framework/multibody/expression_loads.hpp"
#include "framework/simulation/excitation.hpp"

namespace twinmap {

/// What a simulator keeps from sample to sample: names, compiled expressions, excitation.
struct ModelContext {
  /// Throws ExperimentError as its members do. `model` must outlive the context unchanged.
  explicit ModelContext(const ModelSpec& model);

  const ModelSpec& model;
  SystemNames names;
  ModelNumbers numbers;
  ExpressionLoads loads;
  Excitation excitation;
};

/// The system of one parameter set with all that acts on it.
class LoadedSystem {
 public:
  /// Builds the system for the current values of the context's numbers, with muted excitation.
  /// `for_simbody`: make the forces visible to Simbody's own integrators. Throws SimulationFailure.
  LoadedSystem(ModelContext& context, bool for_simbody);

  const BodyTree& getTree() const { return tree_; }

  /// Sums all forces at time t and a state that is realized to Velocity; overwrites both vectors.
  void calcForces(const SimTK::State& state, double t, SimTK::Vector_<SimTK::SpatialVec>& body_forces,
                  SimTK::Vector& mobility_forces);

  /// u' of M(q) u' = f(t, q, u) - c(q, u) at a state that is realized to Velocity; without excitation's time
  /// when muted. Valid until the next call. Throws SimulationFailure if the mass matrix is singular.
  /// Cost: one mass matrix, one inverse dynamics and a Cholesky solve, which for up to some twenty
  /// coordinates is cheaper than Simbody's realize(Acceleration) and agrees with it to rounding.
  const SimTK::Vector& calcUDot(const SimTK::State& state, double t);

 private:
  ModelContext& context_;
  BodyTree tree_;
  PassiveForces passive_;
  std::vector<double> signals_;
  SimTK::Vector_<SimTK::SpatialVec> body_forces_;
  SimTK::Vector mobility_forces_, residual_, udot_;
  const SimTK::Vector zero_udot_;  ///< empty: Simbody takes it as zero
  SimTK::Matrix mass_matrix_;
};

}  // namespace twinmap
