#include "kernels/lanes/program/differentiate.hpp"

#include <algorithm>
#include <cassert>

#include "kernels/lanes/program/recorder.hpp"

namespace twinmap::program {
namespace {

constexpr double kLn2 = 0.693147180559945309417;
constexpr double kLn10 = 2.302585092994045684018;

/// The derivative of y = f(x) with respect to x.
Symbol calcSlope(Operation operation, Symbol x, Symbol y) {
  switch (operation) {
    case Operation::kNegate:
      return -1.0;
    case Operation::kSqrt:
      return 0.5 / y;
    case Operation::kAbs:
      return sign(x);
    case Operation::kSin:
      return cos(x);
    case Operation::kCos:
      return -sin(x);
    case Operation::kTan:
      return 1.0 + y * y;
    case Operation::kAsin:
      return 1.0 / sqrt(1.0 - x * x);
    case Operation::kAcos:
      return -1.0 / sqrt(1.0 - x * x);
    case Operation::kAtan:
      return 1.0 / (1.0 + x * x);
    case Operation::kExp:
      return y;
    case Operation::kLog:
      return 1.0 / x;
    case Operation::kLog2:
      return (1.0 / kLn2) / x;
    case Operation::kLog10:
      return (1.0 / kLn10) / x;
    case Operation::kSinh:
      return cosh(x);
    case Operation::kCosh:
      return sinh(x);
    case Operation::kTanh:
      return 1.0 - y * y;
    case Operation::kAsinh:
      return 1.0 / sqrt(1.0 + x * x);
    case Operation::kAcosh:
      return 1.0 / (sqrt(x - 1.0) * sqrt(x + 1.0));
    case Operation::kAtanh:
      return 1.0 / (1.0 - x * x);
    default:
      return 0.0;  // steps
  }
}

/// d(x^y) = y x^(y-1) dx + x^y log(x) dy
Symbol calcPowerTangent(Symbol x, Symbol dx, Symbol y, Symbol dy, Symbol power) {
  return y * pow(x, y - 1.0) * dx + (dy.isLiteral(0.0) ? Symbol(0.0) : power * log(x) * dy);
}

/// One direction through the graph. Operands stand before their results, so that one pass suffices.
class ForwardMode {
 public:
  ForwardMode(Recorder& recorder, const std::vector<Seed>& seeds) : recorder_(recorder) {
    for (const Seed& seed : seeds) {
      assert(countOperands(recorder.getNode(seed.variable).operation) == 0);
      const std::size_t node = seed.variable.getNode();
      tangents_.resize(std::max(tangents_.size(), node + 1));
      tangents_[node] = seed.tangent;
    }
  }

  /// Inputs keep their seed or 0.
  void run(const std::vector<char>& needed) {
    tangents_.resize(std::max(tangents_.size(), needed.size()));
    for (std::size_t node = 0; node < needed.size(); ++node) {
      if (needed[node] && countOperands(recorder_.getNodes()[node].operation) > 0) {
        tangents_[node] = calcTangent(static_cast<int>(node));
      }
    }
  }

  Symbol getTangent(Symbol value) const {
    return value.isLiteral() ? Symbol(0.0) : tangents_[value.getNode()];
  }

 private:
  Symbol calcTangent(int node) {
    const Node n = recorder_.getNodes()[node];  // a copy: recording moves the nodes
    const int count = countOperands(n.operation);
    const Symbol result = recorder_.getSymbol(node);
    const Symbol a = recorder_.getSymbol(n.a);
    const Symbol da = tangents_[n.a];
    if (count == 1) {
      return da.isLiteral(0.0) ? da : calcSlope(n.operation, a, result) * da;
    }
    const Symbol db = tangents_[n.b];
    if (n.operation == Operation::kSelect) {
      return select(a, db, tangents_[n.c]);
    }
    const bool constant = da.isLiteral(0.0) && db.isLiteral(0.0);
    return constant ? Symbol(0.0) : calcBinary(n.operation, {a, da}, {recorder_.getSymbol(n.b), db}, result);
  }

  struct Dual {
    Symbol value, tangent;
  };
  static Symbol calcBinary(Operation operation, const Dual& a, const Dual& b, Symbol result) {
    switch (operation) {
      case Operation::kAdd:
        return a.tangent + b.tangent;
      case Operation::kSubtract:
        return a.tangent - b.tangent;
      case Operation::kMultiply:
        return a.value * b.tangent + b.value * a.tangent;
      case Operation::kDivide:  // 1 / b is shared by all directions
        return (a.tangent - result * b.tangent) * (1.0 / b.value);
      case Operation::kAtan2:
        return (b.value * a.tangent - a.value * b.tangent) / (a.value * a.value + b.value * b.value);
      case Operation::kPow:
        return calcPowerTangent(a.value, a.tangent, b.value, b.tangent, result);
      case Operation::kMin:
        return select(less(b.value, a.value), b.tangent, a.tangent);
      case Operation::kMax:
        return select(less(a.value, b.value), b.tangent, a.tangent);
      default:
        return 0.0;  // comparisons
    }
  }

  Recorder& recorder_;
  std::vector<Symbol> tangents_;
};

Recorder* findRecorder(const std::vector<Symbol>& values) {
  for (const Symbol& value : values) {
    if (!value.isLiteral()) {
      return value.getRecorder();
    }
  }
  return nullptr;
}

/// For each node up to the last value: whether a value depends on it.
std::vector<char> findNeeded(const Recorder& recorder, const std::vector<Symbol>& values) {
  std::vector<char> needed(recorder.getNodes().size(), false);
  for (const Symbol& value : values) {
    if (!value.isLiteral()) {
      needed[value.getNode()] = true;
    }
  }
  for (int i = static_cast<int>(needed.size()) - 1; i >= 0; --i) {
    const Node& node = recorder.getNodes()[i];
    const int operands[] = {node.a, node.b, node.c};
    for (int k = 0; needed[i] && k < countOperands(node.operation); ++k) {
      needed[operands[k]] = true;
    }
  }
  return needed;
}

}  // namespace

std::vector<Symbol> calcTangents(const std::vector<Symbol>& values, const std::vector<Seed>& seeds) {
  std::vector<Symbol> result(values.size());
  Recorder* const recorder = findRecorder(values);
  if (recorder == nullptr) {
    return result;
  }
  ForwardMode mode(*recorder, seeds);
  mode.run(findNeeded(*recorder, values));
  for (std::size_t i = 0; i < values.size(); ++i) {
    result[i] = mode.getTangent(values[i]);
  }
  return result;
}

std::vector<std::vector<Symbol>> calcJacobian(const std::vector<Symbol>& values,
                                              const std::vector<Symbol>& variables) {
  std::vector<std::vector<Symbol>> columns;
  for (const Symbol& variable : variables) {
    columns.push_back(calcTangents(values, {{variable, 1.0}}));
  }
  return columns;
}

}  // namespace twinmap::program
