// The rules by which record() writes down less than it is asked to.
#include <cassert>
#include <cmath>

#include "kernels/lanes/program/real.hpp"
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

Symbol negate(Operation operation, Symbol a) {
  if (is(a, Operation::kNegate)) {
    return getOperand(a, &Node::a);
  }
  if (is(a, Operation::kSubtract)) {
    return getOperand(a, &Node::b) - getOperand(a, &Node::a);
  }
  return append(operation, a);
}

Symbol add(Operation operation, Symbol a, Symbol b) {
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
  return append(operation, a, b);
}

Symbol subtract(Operation operation, Symbol a, Symbol b) {
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
  return append(operation, a, b);
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

Symbol multiply(Operation operation, Symbol a, Symbol b) {
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
  return append(operation, a, b);
}

/// A divisor that is known earlier is inverted there: a product is several times cheaper than a quotient.
Symbol divide(Operation operation, Symbol a, Symbol b) {
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
  return append(operation, a, b);
}

template <typename S>
S expandPower(S x, int exponent) {
  if (exponent == 1) {
    return x;
  }
  const S half = expandPower(x, exponent / 2);
  return exponent % 2 == 0 ? half * half : half * half * x;
}

/// x^y of a known exponent; `general` where products and roots do not give it.
template <typename S, typename General>
S calcPower(S x, double y, const General& general) {
  using namespace real;
  if (y == 0.0) {
    return 1.0;
  }
  if (y == 0.5) {
    return sqrt(x);
  }
  if (y == std::rint(y) && std::abs(y) <= kLargestExpandedPower) {
    const int exponent = static_cast<int>(y);
    return exponent > 0 ? expandPower(x, exponent) : S(1.0) / expandPower(x, -exponent);
  }
  return general();
}

Symbol power(Operation operation, Symbol x, Symbol y) {
  const auto general = [&] { return append(operation, x, y); };
  return y.isLiteral() ? calcPower(x, y.getLiteral(), general) : general();
}

Symbol choose(Operation operation, Symbol condition, Symbol a, Symbol b) {
  if (condition.isLiteral()) {
    return condition.getLiteral() != 0.0 ? a : b;
  }
  const bool same_literal = a.isLiteral() && b.isLiteral() && a.getLiteral() == b.getLiteral();
  return isSame(a, b) || same_literal ? a : append(operation, condition, a, b);
}

/// sin(-x) and its like.
Symbol odd(Operation operation, Symbol x) {
  return is(x, Operation::kNegate) ? -record(operation, getOperand(x, &Node::a)) : append(operation, x);
}
/// cos(-x) and its like.
Symbol even(Operation operation, Symbol x) {
  return is(x, Operation::kNegate) ? record(operation, getOperand(x, &Node::a)) : append(operation, x);
}

Symbol keep(Operation operation, Symbol a, Symbol b = {}) {
  return append(operation, a, b);
}

Symbol simplify(Operation operation, Symbol a, Symbol b, Symbol c) {
  switch (operation) {
#define TWINMAP_UNARY(kind, function, rule, ...) \
  case Operation::k##kind:                       \
    return rule(operation, a);
#define TWINMAP_BINARY(kind, function, commutes, rule, ...) \
  case Operation::k##kind:                                  \
    return rule(operation, a, b);
#define TWINMAP_TERNARY(kind, function, rule, ...) \
  case Operation::k##kind:                         \
    return rule(operation, a, b, c);
    TWINMAP_UNARY_OPERATIONS(TWINMAP_UNARY)
    TWINMAP_BINARY_OPERATIONS(TWINMAP_BINARY)
    TWINMAP_TERNARY_FUNCTIONS(TWINMAP_TERNARY)
#undef TWINMAP_UNARY
#undef TWINMAP_BINARY
#undef TWINMAP_TERNARY
    default:
      assert(false && "an input, or what compile() makes");
      return {};
  }
}

}  // namespace

Symbol record(Operation operation, Symbol a, Symbol b, Symbol c) {
  const bool literal = a.isLiteral() && b.isLiteral() && c.isLiteral();
  return literal ? Symbol(apply(operation, a.getLiteral(), b.getLiteral(), c.getLiteral()))
                 : simplify(operation, a, b, c);
}

double apply(Operation operation, double a, double b, double c) {
  const auto general = [&] { return evaluate(operation, a, b, c); };
  return operation == Operation::kPow ? calcPower(a, b, general) : general();
}

}  // namespace twinmap::program
