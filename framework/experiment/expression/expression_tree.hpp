#pragma once

#include <array>
#include <string>
#include <vector>

#include "framework/experiment/expression/expression.hpp"
#include "kernels/lanes/program/operation.hpp"

namespace twinmap {

/// An expression as a sequence of the operations of recorded programs, operands before what uses them, so
/// that it can be evaluated over any scalar (NamedValues).
struct ExpressionTree {
  struct Node {
    program::Operation operation = program::Operation::kLiteral;
    double literal = 0.0;                     ///< of kLiteral
    std::array<int, 3> operands{-1, -1, -1};  ///< nodes before this one; of kParameter, its place in `names`
    int call = -1;  ///< its place in `calls`: then a function of the first operand that names are bound to
  };
  /// A function that is none of the grammar's: perhaps a curve.
  struct Call {
    std::string name;
    std::size_t character;
  };
  std::vector<Node> nodes;         ///< the last one is the value
  std::vector<std::string> names;  ///< in order of appearance
  std::vector<Call> calls;
};

/// Parses an expression. From the weakest to the strongest:
///
///   c ? a : b        from right to left; both sides are computed
///   ||               1 or 0; any number but 0 is true
///   &&
///   < <= > >= == !=  1 or 0
///   + -
///   * /
///   - +              signs: -x^2 = -(x^2)
///   ^                from right to left: x^y^z = x^(y^z)
///
/// then numbers (decimal), names, parentheses and functions: those of one operand in operation_list.hpp, ln
/// (log), atan2(y, x), and of any number of operands min, max, sum and avg; the constants pi, _pi and _e.
/// Other functions of one operand are left to who binds the names. Throws ExperimentError with the character
/// at which it is not understood, for an assignment, for more than 4000 characters or 1024 levels of nesting.
/// Cost: linear in its length.
ExpressionTree parseExpression(const Expression& expression);

/// Names of the grammar's functions, for messages.
std::vector<std::string> listFunctions();

}  // namespace twinmap
