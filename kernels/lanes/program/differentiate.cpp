#include "kernels/lanes/program/differentiate.hpp"

#include <algorithm>
#include <cassert>

#include "kernels/lanes/program/recorder.hpp"

namespace twinmap::program {
namespace {

/// The derivative of y = f(a) with respect to a.
Symbol calcSlope(Operation operation, Symbol a, Symbol y) {
  switch (operation) {
#define TWINMAP_SLOPE(kind, function, rule, value, slope) \
  case Operation::k##kind:                                \
    return slope;
    TWINMAP_UNARY_OPERATIONS(TWINMAP_SLOPE)
#undef TWINMAP_SLOPE
    default:
      assert(false && "made by compile()");
      return {};
  }
}

/// The change of y = f(a, b).
Symbol calcBinary(Operation operation, Symbol a, Symbol da, Symbol b, Symbol db, Symbol y) {
  switch (operation) {
#define TWINMAP_TANGENT(kind, function, commutes, rule, value, tangent) \
  case Operation::k##kind:                                              \
    return tangent;
    TWINMAP_BINARY_OPERATIONS(TWINMAP_TANGENT)
#undef TWINMAP_TANGENT
    default:
      assert(false && "made by compile()");
      return {};
  }
}

/// The change of f(a, b, c), of which a is a condition.
Symbol calcTernary(Operation operation, Symbol a, Symbol db, Symbol dc) {
  switch (operation) {
#define TWINMAP_TANGENT(kind, function, rule, value, tangent) \
  case Operation::k##kind:                                    \
    return tangent;
    TWINMAP_TERNARY_FUNCTIONS(TWINMAP_TANGENT)
#undef TWINMAP_TANGENT
    default:
      assert(false && "made by compile()");
      return {};
  }
}

/// One direction through the graph. Operands stand before their results, so that one pass suffices.
class ForwardMode {
 public:
  ForwardMode(Recorder& recorder, const std::vector<Seed>& seeds) : recorder_(recorder) {
    for (const Seed& seed : seeds) {
      if (seed.variable.isLiteral()) {
        continue;
      }
      const std::size_t node = seed.variable.getNode();
      tangents_.resize(std::max(tangents_.size(), node + 1));
      tangents_[node] = seed.tangent;
      seeded_.resize(std::max(seeded_.size(), node + 1));
      seeded_[node] = true;
    }
  }

  /// Inputs and seeded values keep their seed or 0.
  void run(const std::vector<char>& needed) {
    tangents_.resize(std::max(tangents_.size(), needed.size()));
    for (std::size_t node = 0; node < needed.size(); ++node) {
      const bool seeded = node < seeded_.size() && seeded_[node];
      if (needed[node] && !seeded && countOperands(recorder_.getNodes()[node].operation) > 0) {
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
    if (count == 3) {
      return calcTernary(n.operation, a, db, tangents_[n.c]);
    }
    const bool constant = da.isLiteral(0.0) && db.isLiteral(0.0);
    return constant ? Symbol(0.0) : calcBinary(n.operation, a, da, recorder_.getSymbol(n.b), db, result);
  }

  Recorder& recorder_;
  std::vector<Symbol> tangents_;
  std::vector<bool> seeded_;
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
