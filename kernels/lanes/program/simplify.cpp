// The rules by which record() writes down less than it is asked to.
#include <cassert>
#include <cmath>

#include "kernels/lanes/program/evaluate.hpp"
#include "kernels/lanes/program/recorder.hpp"

namespace twinmap::program {
namespace {

constexpr int kLargestExpandedPower = 16;

/// Of operands that are not all literals.
Recorder& getRecorder(Symbol a, Symbol b, Symbol c) {
  const Symbol& recorded = !a.isLiteral() ? a : !b.isLiteral() ? b : c;
  assert(!recorded.isLiteral());
  return *recorded.getRecorder();
}

bool is(Symbol x, Operation operation) {
  return !x.isLiteral() && x.getRecorder()->getNode(x).operation == operation;
}
Symbol getOperand(Symbol x, int Node::*which) {
  return x.getRecorder()->getSymbol(x.getRecorder()->getNode(x).*which);
}
bool isSame(Symbol a, Symbol b) {
  return !a.isLiteral() && !b.isLiteral() && a.getNode() == b.getNode();
}
Level getLevel(Symbol x) {
  return x.isLiteral() ? Level::kLiteral : x.getRecorder()->getNode(x).level;
}
Symbol append(Operation operation, Symbol a, Symbol b = {}, Symbol c = {}) {
  return getRecorder(a, b, c).append(operation, a, b, c);
}

Symbol negate(Symbol a) {
  if (is(a, Operation::kNegate)) {
    return getOperand(a, &Node::a);
  }
  if (is(a, Operation::kSubtract)) {
    return getOperand(a, &Node::b) - getOperand(a, &Node::a);
  }
  return append(Operation::kNegate, a);
}

Symbol add(Symbol a, Symbol b) {
  if (a.isLiteral(0.0)) {
    return b;
  }
  if (b.isLiteral(0.0)) {
    return a;
  }
  if (is(b, Operation::kNegate)) {
    return a - getOperand(b, &Node::a);
  }
  if (is(a, Operation::kNegate)) {
    return b - getOperand(a, &Node::a);
  }
  return append(Operation::kAdd, a, b);
}

Symbol subtract(Symbol a, Symbol b) {
  if (b.isLiteral(0.0)) {
    return a;
  }
  if (a.isLiteral(0.0)) {
    return -b;
  }
  if (isSame(a, b)) {
    return 0.0;
  }
  if (is(b, Operation::kNegate)) {
    return a + getOperand(b, &Node::a);
  }
  if (is(a, Operation::kNegate)) {
    return -(getOperand(a, &Node::a) + b);
  }
  return append(Operation::kSubtract, a, b);
}

/// p * (q * x) becomes (p * q) * x where p is known earlier than x: then so may be p * q.
Symbol gatherFactors(Symbol p, Symbol product) {
  const Symbol q = getOperand(product, &Node::a);
  const Symbol x = getOperand(product, &Node::b);
  if (getLevel(q) < getLevel(x)) {
    return (p * q) * x;
  }
  return getLevel(x) < getLevel(q) ? (p * x) * q : append(Operation::kMultiply, p, product);
}

Symbol multiply(Symbol a, Symbol b) {
  if (getLevel(b) < getLevel(a)) {
    return b * a;
  }
  if (a.isLiteral(0.0)) {
    return 0.0;
  }
  if (a.isLiteral(1.0)) {
    return b;
  }
  if (a.isLiteral(-1.0)) {
    return -b;
  }
  if (is(a, Operation::kNegate)) {
    return -(getOperand(a, &Node::a) * b);
  }
  if (is(b, Operation::kNegate)) {
    return -(a * getOperand(b, &Node::a));
  }
  if (getLevel(a) < getLevel(b) && is(b, Operation::kMultiply)) {
    return gatherFactors(a, b);
  }
  return append(Operation::kMultiply, a, b);
}

/// A divisor that is known earlier is inverted there: a product is several times cheaper than a quotient.
Symbol divide(Symbol a, Symbol b) {
  if (a.isLiteral(0.0)) {
    return 0.0;
  }
  if (is(a, Operation::kNegate)) {
    return -(getOperand(a, &Node::a) / b);
  }
  if (is(b, Operation::kNegate)) {
    return -(a / getOperand(b, &Node::a));
  }
  if (getLevel(b) < getLevel(a)) {
    return a * (Symbol(1.0) / b);
  }
  return append(Operation::kDivide, a, b);
}

Symbol expandPower(Symbol x, int exponent) {
  if (exponent == 1) {
    return x;
  }
  const Symbol half = expandPower(x, exponent / 2);
  return exponent % 2 == 0 ? half * half : half * half * x;
}

Symbol power(Symbol x, Symbol y) {
  if (y.isLiteral(0.0)) {
    return 1.0;
  }
  if (y.isLiteral(0.5)) {
    return sqrt(x);
  }
  if (y.isLiteral() && y.getLiteral() == std::rint(y.getLiteral()) &&
      std::abs(y.getLiteral()) <= kLargestExpandedPower) {
    const int exponent = static_cast<int>(y.getLiteral());
    return exponent > 0 ? expandPower(x, exponent) : Symbol(1.0) / expandPower(x, -exponent);
  }
  return append(Operation::kPow, x, y);
}

Symbol choose(Symbol condition, Symbol a, Symbol b) {
  if (condition.isLiteral()) {
    return condition.getLiteral() != 0.0 ? a : b;
  }
  const bool same_literal = a.isLiteral() && b.isLiteral() && a.getLiteral() == b.getLiteral();
  return isSame(a, b) || same_literal ? a : append(Operation::kSelect, condition, a, b);
}

/// sin(-x) and its like.
bool isOdd(Operation operation) {
  switch (operation) {
    case Operation::kSin:
    case Operation::kTan:
    case Operation::kAsin:
    case Operation::kAtan:
    case Operation::kSinh:
    case Operation::kTanh:
    case Operation::kAsinh:
    case Operation::kAtanh:
      return true;
    default:
      return false;
  }
}
bool isEven(Operation operation) {
  return operation == Operation::kCos || operation == Operation::kCosh || operation == Operation::kAbs;
}

Symbol applyFunction(Operation operation, Symbol x) {
  if (is(x, Operation::kNegate) && (isOdd(operation) || isEven(operation))) {
    const Symbol value = record(operation, getOperand(x, &Node::a));
    return isOdd(operation) ? -value : value;
  }
  return append(operation, x);
}

Symbol simplify(Operation operation, Symbol a, Symbol b, Symbol c) {
  switch (operation) {
    case Operation::kAdd:
      return add(a, b);
    case Operation::kSubtract:
      return subtract(a, b);
    case Operation::kMultiply:
      return multiply(a, b);
    case Operation::kDivide:
      return divide(a, b);
    case Operation::kNegate:
      return negate(a);
    case Operation::kPow:
      return power(a, b);
    case Operation::kSelect:
      return choose(a, b, c);
    default:
      return countOperands(operation) == 1 ? applyFunction(operation, a) : append(operation, a, b);
  }
}

}  // namespace

Symbol record(Operation operation, Symbol a, Symbol b, Symbol c) {
  const bool literal = a.isLiteral() && b.isLiteral() && c.isLiteral();
  return literal ? Symbol(evaluate(operation, a.getLiteral(), b.getLiteral(), c.getLiteral()))
                 : simplify(operation, a, b, c);
}

}  // namespace twinmap::program
