#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "framework/models/mechanism/equations/reactions.hpp"
#include "framework/models/mechanism/load_numbers.hpp"
#include "framework/models/mechanism/loops/assembly.hpp"
#include "framework/models/mechanism/loops/make_loop_model.hpp"
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
  std::shared_ptr<const LoopModel> loops = makeLoopModel(*this);  ///< null: none
  std::optional<Assembly> assembly = loops ? std::make_optional<Assembly>(*loops) : std::optional<Assembly>();
};

/// Of central differences of a system's accelerations: the cube root of the rounding unit.
inline constexpr double kDifferenceStep = 6e-6;

/// The system of one parameter set with all that acts on it.
class LoadedSystem {
 public:
  /// Builds the system for the current values of the context's numbers, with muted excitation.
  /// `for_simbody`: make the forces visible to Simbody's own integrators; where there are states of first
  /// order, constraints or outputs of reactions they are. Throws SimulationFailure.
  LoadedSystem(SimbodyContext& context, bool for_simbody);
  LoadedSystem(const LoadedSystem&) = delete;
  LoadedSystem& operator=(const LoadedSystem&) = delete;

  const BodyTree& getTree() const { return tree_; }
  SimbodyContext& getContext() const { return context_; }

  /// Sums all forces at time t and a state that is realized to Velocity. Valid until the next call, as are
  /// the rates of the states of first order and what expressions of the context give.
  const SystemForces& calcForces(const SimTK::State& state, double t);
  const std::vector<double>& getStateRates() const { return loads_.state_rates; }
  int countStates() const { return static_cast<int>(states_.size()); }

  /// u' at time t and a state that is realized to Velocity. Valid until the next call. Throws
  /// SimulationFailure if the mass matrix is singular.
  const Eigen::VectorXd& calcUDot(const SimTK::State& state, double t);

  /// At the state of the last call of calcForces() or calcUDot(). `expression`: an output's, by its address;
  /// nameAccelerations() comes first.
  double calcExpression(const Expression& expression) const { return context_.expressions.calc(expression); }
  void nameAccelerations(const SimTK::State& state, const SimTK::Vector& udot);
  /// What a force element exerts.
  equations::Exerted<double> calcElementForce(const NamedForce& which);
  SimTK::Vec3 getGravity() const {
    return SimTK::Vec3(numbers_.gravity.x, numbers_.gravity.y, numbers_.gravity.z);
  }

 private:
  void readMotion(const SimTK::State& state);
  void readGravity(const SimTK::State& state);

  SimbodyContext& context_;
  BodyTree tree_;
  LoadNumbers numbers_;
  std::vector<double> coordinates_, rates_, gravity_, states_, signals_, signal_rates_;
  std::vector<equations::BodyMotion<double>> motions_;  ///< ground first; without columns and bias
  equations::Loads<double> loads_;
  SystemForces forces_;
  std::optional<TreeDynamics> dynamics_;
  Eigen::VectorXd udot_;  ///< by Simbody, where there are constraints
};

}  // namespace twinmap
