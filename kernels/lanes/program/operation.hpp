#pragma once

#include <cstdint>

#include "kernels/lanes/program/operation_list.hpp"

namespace twinmap::program {

#define TWINMAP_KIND(kind, ...) k##kind,

/// What an instruction does with its operands a, b and c: see operation_list.hpp.
enum class Operation : std::uint8_t {
  // where values come from; they have no operands
  kLiteral,
  kTime,
  kState,
  kParameter,
  kPhaseInput,
  // what is computed
  TWINMAP_UNARY_OPERATIONS(TWINMAP_KIND)   //
  TWINMAP_BINARY_OPERATIONS(TWINMAP_KIND)  //
  TWINMAP_TERNARY_FUNCTIONS(TWINMAP_KIND)  //
  TWINMAP_FUSED_OPERATIONS(TWINMAP_KIND)   //
  kSinCos,                                 ///< two results of one argument; made by compile()
  kCount
};

#undef TWINMAP_KIND

/// How many operands it has, 0 to 3.
constexpr int countOperands(Operation operation) {
  return operation < Operation::kNegate   ? 0
         : operation < Operation::kAdd    ? 1
         : operation < Operation::kSelect ? 2
         : operation < Operation::kSinCos ? 3
                                          : 1;
}

constexpr bool isCommutative(Operation operation) {
  switch (operation) {
#define TWINMAP_COMMUTES(kind, function, commutes, ...) \
  case Operation::k##kind:                              \
    return commutes;
    TWINMAP_BINARY_OPERATIONS(TWINMAP_COMMUTES)
#undef TWINMAP_COMMUTES
    default:
      return false;
  }
}

/// How often a value has to be computed.
enum class Level : std::uint8_t {
  kLiteral,     ///< once
  kParameter,   ///< once a sample
  kPhase,       ///< once a phase: it depends on a phase input
  kEvaluation,  ///< at each evaluation: it depends on time or state
};

/// The value of an operation of one result on numbers, as the interpreter computes it: the same bits.
double evaluate(Operation operation, double a, double b = 0.0, double c = 0.0);

/// The same for a program that knows the exponent of a power: one that is a small whole number or a half
/// becomes products or a root, as record() writes it down. Templates over the scalar find the function for a
/// Symbol under the same name.
double apply(Operation operation, double a, double b = 0.0, double c = 0.0);

}  // namespace twinmap::program
