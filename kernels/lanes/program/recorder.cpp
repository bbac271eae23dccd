#include "kernels/lanes/program/recorder.hpp"

#include <algorithm>
#include <cassert>
#include <cstring>
#include <utility>

namespace twinmap::program {
namespace {

std::uint64_t getBits(double value) {
  std::uint64_t bits;
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}

}  // namespace

std::size_t Recorder::Hash::operator()(const Node& node) const {
  std::uint64_t hash = getBits(node.literal) + static_cast<std::uint64_t>(node.operation);
  for (const int operand : {node.a, node.b, node.c}) {
    hash = (hash ^ static_cast<std::uint32_t>(operand)) * 0x9E3779B97F4A7C15u;  // Fibonacci hashing
    hash ^= hash >> 29;
  }
  return hash;
}

bool Recorder::Same::operator()(const Node& x, const Node& y) const {
  return x.operation == y.operation && x.a == y.a && x.b == y.b && x.c == y.c &&
         getBits(x.literal) == getBits(y.literal);
}

int Recorder::findOrAppend(const Node& node) {
  const auto [place, is_new] = index_.try_emplace(node, static_cast<int>(nodes_.size()));
  if (is_new) {
    nodes_.push_back(node);
  }
  return place->second;
}

Symbol Recorder::input(Operation operation, int index, Level level) {
  assert(index >= 0);
  Node node;
  node.operation = operation;
  node.a = index;
  node.level = level;
  return {*this, findOrAppend(node)};
}

Symbol Recorder::time() {
  return input(Operation::kTime, 0, Level::kEvaluation);
}
Symbol Recorder::state(int index) {
  return input(Operation::kState, index, Level::kEvaluation);
}
Symbol Recorder::parameter(int index) {
  return input(Operation::kParameter, index, Level::kParameter);
}
Symbol Recorder::phaseInput(int index) {
  return input(Operation::kPhaseInput, index, Level::kPhase);
}

int Recorder::findNode(Symbol symbol) {
  if (!symbol.isLiteral()) {
    assert(symbol.getRecorder() == this);
    return symbol.getNode();
  }
  Node node;
  node.literal = symbol.getLiteral();
  return findOrAppend(node);
}

Symbol Recorder::getSymbol(int node) {
  return nodes_[node].operation == Operation::kLiteral ? Symbol(nodes_[node].literal) : Symbol(*this, node);
}

Symbol Recorder::append(Operation operation, Symbol a, Symbol b, Symbol c) {
  const int count = countOperands(operation);
  Node node;
  node.operation = operation;
  node.a = findNode(a);
  node.b = count > 1 ? findNode(b) : -1;
  node.c = count > 2 ? findNode(c) : -1;
  if (isCommutative(operation) && node.a > node.b) {
    std::swap(node.a, node.b);
  }
  for (const int operand : {node.a, node.b, node.c}) {
    node.level = operand < 0 ? node.level : std::max(node.level, nodes_[operand].level);
  }
  return {*this, findOrAppend(node)};
}

}  // namespace twinmap::program
