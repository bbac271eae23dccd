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

Recorder* findRecorder(const std::vector<Symbol>& values) {
  for (const Symbol& value : values) {
    if (!value.isLiteral()) {
      return value.getRecorder();
    }
  }
  return nullptr;
}

/// The operations that values depend on, operands before their results.
std::vector<int> listOperations(const Recorder& recorder, const std::vector<Symbol>& values) {
  int last = -1;
  for (const Symbol& value : values) {
    last = value.isLiteral() ? last : std::max(last, value.getNode());
  }
  std::vector<char> needed(static_cast<std::size_t>(last + 1), false);
  for (const Symbol& value : values) {
    if (!value.isLiteral()) {
      needed[value.getNode()] = true;
    }
  }
  std::vector<int> operations;
  for (int i = last; i >= 0; --i) {
    const Node& node = recorder.getNodes()[i];
    const int operands[] = {node.a, node.b, node.c};
    const int count = countOperands(node.operation);
    if (needed[i] && count > 0) {
      operations.push_back(i);
      for (int k = 0; k < count; ++k) {
        needed[operands[k]] = true;
      }
    }
  }
  std::reverse(operations.begin(), operations.end());
  return operations;
}

}  // namespace

Differentiator::Differentiator(std::vector<Symbol> values)
    : values_(std::move(values)), recorder_(findRecorder(values_)) {
  if (recorder_ != nullptr) {
    operations_ = listOperations(*recorder_, values_);
    tangents_.resize(recorder_->getNodes().size());
    is_seeded_.resize(tangents_.size());
  }
}

std::vector<Symbol> Differentiator::calcTangents(const std::vector<Seed>& seeds) {
  std::vector<int> changed;
  for (const Seed& seed : seeds) {
    // what was recorded after the values is none of what they depend on
    if (!seed.variable.isLiteral() && seed.variable.getNode() < static_cast<int>(tangents_.size())) {
      changed.push_back(seed.variable.getNode());
      tangents_[changed.back()] = seed.tangent;
      is_seeded_[changed.back()] = true;
    }
  }
  for (const int node : operations_) {
    if (!is_seeded_[node]) {
      if (const Symbol tangent = calcTangent(node); !tangent.isLiteral(0.0)) {
        tangents_[node] = tangent;
        changed.push_back(node);
      }
    }
  }
  std::vector<Symbol> result;
  for (const Symbol& value : values_) {
    result.push_back(value.isLiteral() ? Symbol(0.0) : tangents_[value.getNode()]);
  }
  for (const int node : changed) {
    tangents_[node] = Symbol(0.0);
    is_seeded_[node] = false;
  }
  return result;
}

Symbol Differentiator::calcTangent(int node) const {
  const Node n = recorder_->getNodes()[node];  // a copy: recording moves the nodes
  const int count = countOperands(n.operation);
  const Symbol da = tangents_[n.a];
  const Symbol db = count > 1 ? tangents_[n.b] : Symbol(0.0);
  const Symbol dc = count > 2 ? tangents_[n.c] : Symbol(0.0);
  if (da.isLiteral(0.0) && db.isLiteral(0.0) && dc.isLiteral(0.0)) {
    return 0.0;
  }
  const Symbol a = recorder_->getSymbol(n.a);
  switch (count) {
    case 1:
      return calcSlope(n.operation, a, recorder_->getSymbol(node)) * da;
    case 2:
      return calcBinary(n.operation, a, da, recorder_->getSymbol(n.b), db, recorder_->getSymbol(node));
    default:
      return calcTernary(n.operation, a, db, dc);
  }
}

std::vector<Symbol> calcTangents(const std::vector<Symbol>& values, const std::vector<Seed>& seeds) {
  return Differentiator(values).calcTangents(seeds);
}

std::vector<std::vector<Symbol>> calcJacobian(const std::vector<Symbol>& values,
                                              const std::vector<Symbol>& variables) {
  Differentiator differentiator(values);
  std::vector<std::vector<Symbol>> columns;
  for (const Symbol& variable : variables) {
    columns.push_back(differentiator.calcTangents({{variable, 1.0}}));
  }
  return columns;
}

}  // namespace twinmap::program
