#pragma once

#include <vector>

#include "framework/experiment/model/armature_spec.hpp"
#include "framework/experiment/model/body_spec.hpp"
#include "framework/experiment/model/constraint_spec.hpp"
#include "framework/experiment/model/controller_spec.hpp"
#include "framework/experiment/model/curve_spec.hpp"
#include "framework/experiment/model/elements/element_lists.hpp"
#include "framework/experiment/model/initial_spec.hpp"
#include "framework/experiment/model/motion_spec.hpp"
#include "framework/experiment/model/state_spec.hpp"

namespace twinmap {

struct SystemSpec {
  Expression3 gravity;  ///< m/s2, in the ground frame; zero by default
  std::vector<BodySpec> bodies;
  std::vector<StateSpec> states;             ///< of first order
  std::vector<CurveSpec> curves;             ///< functions that expressions of the state may use
  std::vector<NamedExpression> expressions;  ///< each may use those before it
  std::vector<MotionSpec> motions;           ///< prescribed ones
  std::vector<ArmatureSpec> armature;        ///< inertias of coordinates
  std::vector<ControllerSpec> controllers;   ///< sampled ones
  ForceElements<Expression> elements;
  std::vector<ConstraintSpec> constraints;  ///< beside those of the joints: loops, rods, gears

  // compiled once (experiment_spec.cpp)
  SystemSpec();
  SystemSpec(const SystemSpec&);
  SystemSpec(SystemSpec&&) noexcept;
  SystemSpec& operator=(const SystemSpec&);
  SystemSpec& operator=(SystemSpec&&) noexcept;
  ~SystemSpec();
};

inline bool isGiven(const SystemSpec& system) {
  return !system.bodies.empty();
}

template <class Fields>
void describe(Fields& f, SystemSpec& s) {
  f.optional("gravity", s.gravity, "in the ground frame", Unit{"m/s2"});
  f.requiredMap("bodies", s.bodies, "each with its joint to a parent declared before");
  f.optionalMap("states", s.states, "states of first order: currents, temperatures, filters");
  f.optionalMap("curves", s.curves, "static curves by their knots, for expressions: motor(u)");
  f.optionalMap("expressions", s.expressions,
                "named once, for all expressions that may use coordinates and states");
  f.optional("armature", s.armature, "inertias of coordinates: rotors of drives");
  f.optional("motions", s.motions, "coordinates that move as a signal says");
  f.optionalMap("controllers", s.controllers, "sampled controllers, which read, compute and hold");
  describeElements(f, s.elements);
  f.optional("constraints", s.constraints,
             "closed loops, rods, gears: what bodies satisfy beside their joints");
}

}  // namespace twinmap
