#pragma once

#include <vector>

#include "framework/models/mechanism/equations/model_equations.hpp"
#include "kernels/lanes/program/symbol.hpp"

namespace twinmap {

/// How far controllers are from rest: of each of their outputs what is computed less what it is, of each of
/// their states the next less the present. Nothing moves, sensors are settled and do not round, signals are
/// 0, and so is difference(). What depends on nothing that an equilibrium may change, as a counter does,
/// keeps its start: 0. `rest`: the state; `quantities`: what outputs measure in it; `rates`: of the states of
/// first order, changed.
void addControllersAtRest(const ModelSpec& model, const SystemNames& names,
                          const NamedValues<program::Symbol>& numbers,
                          const equations::ModelState<program::Symbol>& rest,
                          const std::vector<program::Symbol>& quantities,
                          std::vector<program::Symbol>& rates);

}  // namespace twinmap
