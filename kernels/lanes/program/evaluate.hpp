#pragma once

#include "kernels/lanes/program/operation.hpp"

namespace twinmap::program {

/// The value of an operation of one result, as the interpreter computes it: the same bits.
double evaluate(Operation operation, double a, double b = 0.0, double c = 0.0);

}  // namespace twinmap::program
