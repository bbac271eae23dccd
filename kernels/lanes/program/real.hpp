#pragma once

#include "kernels/lanes/program/operation.hpp"

/// The functions of Symbol for doubles, with the bits of recorded programs: a template over the scalar says
/// `using namespace twinmap::program::real;` and calls sin(x), less(a, b), select(c, a, b) for either.
namespace twinmap::program::real {

#define TWINMAP_UNARY(kind, function, ...) \
  inline double function(double a) {       \
    return apply(Operation::k##kind, a);   \
  }
#define TWINMAP_BINARY(kind, function, ...)    \
  inline double function(double a, double b) { \
    return apply(Operation::k##kind, a, b);    \
  }
#define TWINMAP_TERNARY(kind, function, ...)             \
  inline double function(double a, double b, double c) { \
    return apply(Operation::k##kind, a, b, c);           \
  }
TWINMAP_UNARY_FUNCTIONS(TWINMAP_UNARY)
TWINMAP_BINARY_FUNCTIONS(TWINMAP_BINARY)
TWINMAP_TERNARY_FUNCTIONS(TWINMAP_TERNARY)
#undef TWINMAP_UNARY
#undef TWINMAP_BINARY
#undef TWINMAP_TERNARY

}  // namespace twinmap::program::real
