#pragma once

#include <functional>
#include <vector>

#include "framework/models/mechanism/system_names.hpp"
#include "framework/simulation/excitation/excitation.hpp"
#include "framework/simulation/model_numbers.hpp"

namespace twinmap {

/// What a simulator keeps from sample to sample: names, values of parameters and constants, excitation.
struct ModelContext {
  /// Throws ExperimentError as its members do. `model` must outlive the context unchanged.
  explicit ModelContext(const ModelSpec& of)
      : model(of), names(of.system), numbers(of), excitation(of.excitation) {}

  const ModelSpec& model;
  SystemNames names;
  ModelNumbers numbers;
  Excitation excitation;
};

/// Coordinates, their time derivatives, and states of first order, in the order of SystemNames.
struct InitialState {
  Eigen::VectorXd coordinates, speeds, states{};

  /// [coordinates; states], as an equilibrium has them.
  Eigen::VectorXd getEquilibrium() const {
    Eigen::VectorXd both(coordinates.size() + states.size());
    both << coordinates, states;
    return both;
  }
};

/// Values of the initial condition at the current parameter set, without any equilibrium. Throws
/// ExperimentError for a name that is not a coordinate, SimulationFailure for values that are not finite.
InitialState calcInitialValues(ModelContext& context);

/// Where the equilibrium at the box centre is solved for: the centre with the values that replace it, which
/// may use the centre's parameters and constants. The context's numbers must be those of the centre.
Eigen::VectorXd calcEquilibriumPoint(ModelContext& context);

/// Throws SimulationFailure for numbers of the current parameter set that no real system has: as building it
/// would, and in the same order. Cost: some microseconds.
void checkNumbers(ModelContext& context);

/// One of the things that checkNumbers() checks.
struct NumberCheck {
  bool only_finite;  ///< it asks for nothing but that the values of its expressions are finite
  std::function<void(ModelContext&)> check;
};

/// In the order of checkNumbers(). `model` must outlive them.
std::vector<NumberCheck> listNumberChecks(const ModelSpec& model);

}  // namespace twinmap
