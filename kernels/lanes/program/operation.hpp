#pragma once

#include <cstdint>

namespace twinmap::program {

/// What an instruction does with its operands a, b and c. Logical values are 0 and 1; any number but 0 is
/// true.
enum class Operation : std::uint8_t {
  // where values come from; they have no operands
  kLiteral,
  kTime,
  kState,
  kParameter,
  kPhaseInput,
  // arithmetic
  kAdd,
  kSubtract,
  kMultiply,
  kDivide,
  kNegate,
  kMultiplyAdd,          ///< a * b + c, rounded once; made by compile()
  kMultiplySubtract,     ///< a * b - c, likewise
  kNegativeMultiplyAdd,  ///< c - a * b, likewise
  // elementary functions
  kSqrt,
  kAbs,
  kSign,  ///< -1, 0 or 1
  kFloor,
  kRint,  ///< to the nearest integer, halves to the even one
  kSin,
  kCos,
  kSinCos,  ///< two results of one argument; made by compile()
  kTan,
  kAsin,
  kAcos,
  kAtan,
  kAtan2,
  kExp,
  kLog,
  kLog2,
  kLog10,
  kPow,
  kSinh,
  kCosh,
  kTanh,
  kAsinh,
  kAcosh,
  kAtanh,
  kMin,
  kMax,
  // logic
  kLess,
  kLessOrEqual,
  kEqual,
  kNotEqual,
  kAnd,
  kOr,
  kSelect,  ///< a != 0 ? b : c
  kCount
};

/// How many operands it has, 0 to 3.
int countOperands(Operation operation);

constexpr bool isCommutative(Operation operation) {
  return operation == Operation::kAdd || operation == Operation::kMultiply || operation == Operation::kMin ||
         operation == Operation::kMax || operation == Operation::kEqual ||
         operation == Operation::kNotEqual || operation == Operation::kAnd || operation == Operation::kOr;
}

/// How often a value has to be computed.
enum class Level : std::uint8_t {
  kLiteral,     ///< once
  kParameter,   ///< once a sample
  kPhase,       ///< once a phase: it depends on a phase input
  kEvaluation,  ///< at each evaluation: it depends on time or state
};

}  // namespace twinmap::program
