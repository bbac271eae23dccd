#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include "framework/experiment/expression/expression_tree.hpp"
#include "kernels/lanes/program/real.hpp"

namespace twinmap::equations {
namespace expression_nodes {

template <class S>
S calcArithmetic(Operation operation, const S& a, const S& b) {
  using namespace program::real;
  switch (operation) {
    case Operation::kAdd:
      return a + b;
    case Operation::kSubtract:
      return a - b;
    case Operation::kMultiply:
      return a * b;
    case Operation::kDivide:
      return a / b;
    case Operation::kAtan2:
      return atan2(a, b);
    case Operation::kPower:
      return pow(a, b);
    case Operation::kMin:  // as std::min, which muParser uses: a first operand that is NaN stays
      return select(less(b, a), b, a);
    default:
      return select(less(a, b), b, a);
  }
}

/// 1 where it holds, else 0.
template <class S>
S calcComparison(Operation operation, const S& a, const S& b) {
  using namespace program::real;
  switch (operation) {
    case Operation::kLess:
      return less(a, b);
    case Operation::kLessEqual:
      return lessOrEqual(a, b);
    case Operation::kGreater:
      return less(b, a);
    case Operation::kGreaterEqual:
      return lessOrEqual(b, a);
    case Operation::kEqual:
      return equal(a, b);
    case Operation::kNotEqual:
      return notEqual(a, b);
    case Operation::kAnd:
      return both(a, b);
    default:
      return either(a, b);
  }
}

template <class S>
S calcTrigonometric(Operation operation, const S& x) {
  using namespace program::real;
  switch (operation) {
    case Operation::kSin:
      return sin(x);
    case Operation::kCos:
      return cos(x);
    case Operation::kTan:
      return tan(x);
    case Operation::kAsin:
      return asin(x);
    case Operation::kAcos:
      return acos(x);
    case Operation::kAtan:
      return atan(x);
    case Operation::kSinh:
      return sinh(x);
    case Operation::kCosh:
      return cosh(x);
    case Operation::kTanh:
      return tanh(x);
    case Operation::kAsinh:
      return asinh(x);
    case Operation::kAcosh:
      return acosh(x);
    default:
      return atanh(x);
  }
}

template <class S>
S calcFunction(Operation operation, const S& x) {
  using namespace program::real;
  switch (operation) {
    case Operation::kNegate:
      return -x;
    case Operation::kExp:
      return exp(x);
    case Operation::kLog:
      return log(x);
    case Operation::kLog2:
      return log2(x);
    case Operation::kLog10:
      return log10(x);
    case Operation::kSqrt:
      return sqrt(x);
    case Operation::kAbs:
      return abs(x);
    case Operation::kSign:
      return sign(x);
    case Operation::kRint:
      return floor(x + 0.5);  // as muParser rounds
    default:
      return calcTrigonometric(operation, x);
  }
}

inline bool isComparison(Operation operation) {
  return operation >= Operation::kLess && operation <= Operation::kOr;
}

template <class S>
S calcNode(const ExpressionTree::Node& node, const std::vector<S>& values) {
  const std::vector<int>& at = node.operands;
  if (node.operation == Operation::kChoose) {
    using namespace program::real;
    return select(values[at[0]], values[at[1]], values[at[2]]);
  }
  if (at.size() == 1) {
    return calcFunction(node.operation, values[at[0]]);
  }
  return isComparison(node.operation) ? calcComparison(node.operation, values[at[0]], values[at[1]])
                                      : calcArithmetic(node.operation, values[at[0]], values[at[1]]);
}

}  // namespace expression_nodes

/// The value of an expression over a scalar S that is double or program::Symbol. `names`: one value for each
/// of tree.names. As muParser computes it, but that both sides of ?:, && and || are computed. (muParser 2.3
/// rounds the operands of && and || towards 0 where both are constants; this is not repeated.)
template <class S>
S calcExpression(const ExpressionTree& tree, const std::vector<S>& names) {
  std::vector<S> values;
  values.reserve(tree.nodes.size());
  for (const ExpressionTree::Node& node : tree.nodes) {
    values.push_back(node.operation == Operation::kLiteral ? S(node.literal)
                     : node.operation == Operation::kName  ? names[static_cast<std::size_t>(node.name)]
                                                           : expression_nodes::calcNode(node, values));
  }
  return values.back();
}

}  // namespace twinmap::equations
