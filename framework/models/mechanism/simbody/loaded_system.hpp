#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "framework/models/mechanism/equations/force_sum.hpp"
#include "framework/models/mechanism/load_numbers.hpp"
#include "framework/models/mechanism/model_context.hpp"
#include "framework/models/mechanism/simbody/body_tree.hpp"
#include "framework/models/mechanism/simbody/state_expressions.hpp"
#include "framework/models/mechanism/simbody/tree_dynamics.hpp"

namespace twinmap {

/// What a simulator keeps from sample to sample, with the forces that are expressions, compiled.
struct SimbodyContext : ModelContext {
  /// Throws ExperimentError as its members do. `model` must outlive the context unchanged.
  explicit SimbodyContext(const ModelSpec& of) : ModelContext(of), expressions(of, numbers.getValues()) {}

  StateExpressions expressions;
};

/// Of central differences of a system's accelerations: the cube root of the rounding unit.
inline constexpr double kDifferenceStep = 6e-6;

/// The system of one parameter set with all that acts on it.
class LoadedSystem {
 public:
  /// Builds the system for the current values of the context's numbers, with muted excitation.
  /// `for_simbody`: make the forces visible to Simbody's own integrators. Throws SimulationFailure.
  LoadedSystem(SimbodyContext& context, bool for_simbody);
  LoadedSystem(const LoadedSystem&) = delete;
  LoadedSystem& operator=(const LoadedSystem&) = delete;

  const BodyTree& getTree() const { return tree_; }

  /// Sums all forces at time t and a state that is realized to Velocity. Valid until the next call.
  const SystemForces& calcForces(const SimTK::State& state, double t);

  /// u' at time t and a state that is realized to Velocity. Valid until the next call. Throws
  /// SimulationFailure if the mass matrix is singular.
  const Eigen::VectorXd& calcUDot(const SimTK::State& state, double t);

 private:
  void readMotion(const SimTK::State& state);

  SimbodyContext& context_;
  BodyTree tree_;
  LoadNumbers numbers_;
  std::vector<double> coordinates_, rates_, signals_;
  std::vector<equations::BodyMotion<double>> motions_;  ///< ground first; without columns and bias
  equations::Loads<double> loads_;
  SystemForces forces_;
  std::optional<TreeDynamics> dynamics_;
};

}  // namespace twinmap
