#pragma once

#include <string>
#include <vector>

#include "framework/spec/excitation_spec.hpp"
#include "framework/spec/simulation_spec.hpp"
#include "framework/spec/system_spec.hpp"

namespace twinmap {

/// What the relative error of a parameter is relative to: its true value, or the width of its bounds.
enum class RelativeTo { kValue, kRange };

/// A closed interval, lower < upper, both finite.
struct Bounds {
  double lower = 0.0, upper = 0.0;
  SourceLocation where;
};

/// A parameter of the model, sampled within its bounds for training.
struct ParameterSpec {
  Name name;
  Bounds bounds;     ///< in `unit`
  std::string unit;  ///< coherent SI unit, "" if not stated
  std::string description;
  RelativeTo relative_to = RelativeTo::kValue;  ///< of an updating parameter
};

/// A named value of the model; may use parameters of any kind and the constants declared before it.
struct ConstantSpec {
  Name name;
  Expression value;
  std::string unit;
  std::string description;
};

/// Everything that determines a trajectory but the parameter point.
struct ModelSpec {
  std::vector<ParameterSpec> parameters;  ///< updating: to be inferred from a response
  std::vector<ParameterSpec> nuisance;    ///< unknown too, but not inferred: initial state, offset, friction
  std::vector<ParameterSpec> inputs;      ///< known settings of the set-up, given with a measurement
  std::vector<ConstantSpec> constants;
  SystemSpec system;
  std::vector<SignalSpec> excitation;
  InitialSpec initial;
  std::vector<OutputSpec> outputs;
  SimulationSpec simulation;
};

}  // namespace twinmap
