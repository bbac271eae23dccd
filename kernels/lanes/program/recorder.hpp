#pragma once

#include <unordered_map>
#include <vector>

#include "kernels/lanes/program/symbol.hpp"

namespace twinmap::program {

/// One value: an operation on earlier values, an input or a literal.
struct Node {
  Operation operation = Operation::kLiteral;
  int a = -1, b = -1, c = -1;  ///< nodes; of an input, a is its index
  double literal = 0.0;
  Level level = Level::kLiteral;
};

/// Keeps what is computed with its symbols as a graph in which equal terms exist once and every node follows
/// its operands. Inputs are time, states, parameters (constant during a sample) and phase inputs (constant
/// during a phase, such as whether a pulse is on; they depend on no parameter). Cost: 40 bytes and about 100
/// ns a node. Not thread safe.
class Recorder {
 public:
  Recorder() = default;
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  Symbol time();
  Symbol state(int index);
  Symbol parameter(int index);
  Symbol phaseInput(int index);

  const std::vector<Node>& getNodes() const { return nodes_; }
  const Node& getNode(Symbol symbol) const { return nodes_[symbol.getNode()]; }
  Level getLevel(Symbol symbol) const { return symbol.isLiteral() ? Level::kLiteral : getNode(symbol).level; }

  /// The node of a symbol, made where it is a literal.
  int findNode(Symbol symbol);
  /// The symbol of a node; a literal's is a literal.
  Symbol getSymbol(int node);
  /// The value of an operation as it is, found again if it was there before.
  Symbol append(Operation operation, Symbol a, Symbol b, Symbol c);

 private:
  struct Hash {
    std::size_t operator()(const Node& node) const;
  };
  struct Same {
    bool operator()(const Node& x, const Node& y) const;
  };
  Symbol input(Operation operation, int index, Level level);
  int findOrAppend(const Node& node);

  std::vector<Node> nodes_;
  std::unordered_map<Node, int, Hash, Same> index_;
};

}  // namespace twinmap::program
