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

/// The same of many directions: what the values depend on is looked up once.
class Differentiator {
 public:
  explicit Differentiator(std::vector<Symbol> values);

  std::vector<Symbol> calcTangents(const std::vector<Seed>& seeds);

 private:
  Symbol calcTangent(int node) const;

  std::vector<Symbol> values_;
  Recorder* recorder_;            ///< null: all values are literals
  std::vector<int> operations_;   ///< that they depend on, operands before their results
  std::vector<Symbol> tangents_;  ///< of each node; 0 between directions
  std::vector<char> is_seeded_;   ///< likewise
};

/// Column by column: result[j][i] = d values[i] / d variables[j].
std::vector<std::vector<Symbol>> calcJacobian(const std::vector<Symbol>& values,
                                              const std::vector<Symbol>& variables);

}  // namespace twinmap::program
