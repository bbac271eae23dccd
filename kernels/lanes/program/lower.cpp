#include "kernels/lanes/program/lower.hpp"

#include <algorithm>

#include "kernels/lanes/program/recorder.hpp"

namespace twinmap::program {
namespace {

template <typename Function>
void forEachOperand(const Node& node, const Function& function) {
  const int operands[] = {node.a, node.b, node.c};
  std::for_each(operands, operands + countOperands(node.operation), function);
}

/// How many operands and wanted values each node is, counted through what is needed alone.
std::vector<int> countUses(const std::vector<Node>& nodes, const std::vector<int>& wanted) {
  std::vector<int> uses(nodes.size(), 0);
  for (const int node : wanted) {
    ++uses[node];
  }
  for (std::size_t i = nodes.size(); i-- > 0;) {
    if (uses[i] > 0) {
      forEachOperand(nodes[i], [&](int operand) { ++uses[operand]; });
    }
  }
  return uses;
}

/// Makes one instruction of a * b + c, a * b - c or c - a * b. A product used elsewhere too is then computed
/// twice, at no more instructions and a shorter way to the sum. Of two products the one used less is joined.
void fuse(Node& sum, const std::vector<Node>& nodes, const std::vector<int>& uses) {
  const auto isProduct = [&](int operand) {
    return nodes[operand].operation == Operation::kMultiply && nodes[operand].level == sum.level;
  };
  const bool first = isProduct(sum.a) && !(isProduct(sum.b) && uses[sum.b] < uses[sum.a]);
  if (!first && !isProduct(sum.b)) {
    return;
  }
  const Node& product = nodes[first ? sum.a : sum.b];
  const int other = first ? sum.b : sum.a;
  const Operation difference = first ? Operation::kMultiplySubtract : Operation::kNegativeMultiplyAdd;
  sum.operation = sum.operation == Operation::kAdd ? Operation::kMultiplyAdd : difference;
  sum.a = product.a;
  sum.b = product.b;
  sum.c = other;
}

/// From the last sum to the first, so that each finds its products as they were recorded.
void fuseProducts(std::vector<Node>& nodes, const std::vector<int>& uses) {
  for (std::size_t i = nodes.size(); i-- > 0;) {
    const Operation operation = nodes[i].operation;
    if (uses[i] > 0 && (operation == Operation::kAdd || operation == Operation::kSubtract)) {
      fuse(nodes[i], nodes, uses);
    }
  }
}

/// The cosine of each needed sine's argument and the sine of each needed cosine's, where both are; else -1.
std::vector<int> pairSines(const std::vector<Node>& nodes, const std::vector<int>& uses) {
  std::vector<int> cosines(nodes.size(), -1), partners(nodes.size(), -1);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (uses[i] > 0 && nodes[i].operation == Operation::kCos) {
      cosines[nodes[i].a] = static_cast<int>(i);
    }
  }
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (uses[i] > 0 && nodes[i].operation == Operation::kSin && cosines[nodes[i].a] >= 0) {
      partners[i] = cosines[nodes[i].a];
      partners[partners[i]] = static_cast<int>(i);
    }
  }
  return partners;
}

Step makeStep(const std::vector<Node>& nodes, int node, int partner) {
  const Node& n = nodes[node];
  const bool is_cosine = n.operation == Operation::kCos;
  if (partner < 0) {
    return {n.operation, {node, -1}, {n.a, n.b, n.c}};
  }
  return {Operation::kSinCos, {is_cosine ? partner : node, is_cosine ? node : partner}, {n.a, n.b, n.c}};
}

}  // namespace

Steps lower(const Recorder& recorder, const std::vector<int>& wanted) {
  std::vector<Node> nodes = recorder.getNodes();
  fuseProducts(nodes, countUses(nodes, wanted));
  const std::vector<int> uses = countUses(nodes, wanted);
  const std::vector<int> partners = pairSines(nodes, uses);
  Steps steps;
  for (int i = 0; i < static_cast<int>(nodes.size()); ++i) {
    const bool is_made = partners[i] >= 0 && partners[i] < i;  // together with the other of its pair
    if (uses[i] > 0 && !is_made && countOperands(nodes[i].operation) > 0) {
      steps.levels[static_cast<int>(nodes[i].level)].push_back(makeStep(nodes, i, partners[i]));
    }
  }
  return steps;
}

}  // namespace twinmap::program
