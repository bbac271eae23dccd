#pragma once

#include <functional>
#include <vector>

#include "framework/models/mechanism/equations/model_equations.hpp"
#include "kernels/lanes/program/recorder.hpp"

namespace twinmap {

/// Impacts on rigid stops, friction that begins to stick or to slide, and dampers that begin to touch or end:
/// one guard for each switch (equations/switches.hpp), and the states behind its event.
struct RecordedEvents {
  std::vector<program::Symbol> guards;       ///< empty: nothing switches
  std::vector<program::Symbol> dips;         ///< as lanes::Equations::dips
  std::vector<program::Symbol> transitions;  ///< of all states, by the phase input `input`
  int input = -1;                            ///< as lanes::Equations::event_input
};

/// What switches.
struct SwitchedModel {
  const equations::SystemValues<program::Symbol>& system;
  equations::ModelState<program::Symbol> state;  ///< with the modes of all switches
  std::vector<program::Symbol> hidden;           ///< states behind the modes
  program::Symbol event;                         ///< the phase input
  double duration = 0.0;                         ///< of the simulation, s
  std::function<equations::ModelMotion<program::Symbol>(const equations::ModelState<program::Symbol>&)>
      calcMotion;
  /// Of a level of friction, in the state.
  std::function<program::Symbol(const StateNumber<program::Symbol>&)> calcLevel;
};

/// Behind an impact at the speed v towards a stop with restitution e the speed is e v away from it, and other
/// coordinates change as the impulse has it through the mass matrix. Where the flight that follows would take
/// less than a millionth of the simulation, 2 e v / acceleration, the coordinate rests on the stop until the
/// force pulls away: impacts that accumulate end so. Friction whose sliding speed comes to 0 sticks where
/// that takes at most its static level, and slides again where it takes more. A touch changes no state: the
/// force of its damper jumps. Cost: two records of the motion for each stop and friction. All but
/// `input` is filled.
RecordedEvents recordEvents(const SwitchedModel& switched);

}  // namespace twinmap
