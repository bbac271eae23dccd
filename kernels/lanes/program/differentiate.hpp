#pragma once

#include <vector>

#include "kernels/lanes/program/symbol.hpp"

namespace twinmap::program {

/// An input and how it changes along a direction.
struct Seed {
  Symbol variable;
  Symbol tangent;
};

/// How `values` change along the direction given by the seeds: sum over seeds of d value / d variable *
/// tangent, recorded beside the values themselves (forward mode; terms shared between directions are recorded
/// once). What depends on no seed has the literal tangent 0. A step (sign, floor, rint, a comparison) has the
/// derivative 0, abs at 0 as well; min, max and select that of the branch taken. A variable's own definition
/// is not looked into. Cost: about three nodes for each node that depends on a seed.
std::vector<Symbol> calcTangents(const std::vector<Symbol>& values, const std::vector<Seed>& seeds);

/// Column by column: result[j][i] = d values[i] / d variables[j].
std::vector<std::vector<Symbol>> calcJacobian(const std::vector<Symbol>& values,
                                              const std::vector<Symbol>& variables);

}  // namespace twinmap::program
