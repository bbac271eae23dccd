#pragma once

#include <vector>

#include "kernels/lanes/program/symbol.hpp"

namespace twinmap::program {

/// An operation with the values it makes and takes, by node.
struct Step {
  Operation operation;
  int results[2];   ///< -1: none
  int operands[3];  ///< -1: none
};

/// The steps of each level that the wanted nodes need, operands first. Index with a Level.
struct Steps {
  std::vector<Step> levels[4];
};

/// Leaves out what no wanted node needs, joins a product to the sum it enters, and sine to cosine.
Steps lower(const Recorder& recorder, const std::vector<int>& wanted);

}  // namespace twinmap::program
