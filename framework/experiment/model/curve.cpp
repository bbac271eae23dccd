#include "framework/experiment/model/curve.hpp"

#include <fmt/core.h>

namespace twinmap {
namespace {

using program::Operation;
using Places = std::vector<int>;

/// Writes operations down behind those that are there; all members return the place of the result.
class NodeWriter {
 public:
  explicit NodeWriter(CurveExpansion::Nodes& nodes) : nodes_(nodes) {}

  int apply(Operation operation, int a, int b, int c = -1) { return add({operation, 0.0, {a, b, c}}); }
  int literal(double value) { return add({Operation::kLiteral, value, {-1, -1, -1}}); }
  int sum(int a, int b) { return apply(Operation::kAdd, a, b); }
  int difference(int a, int b) { return apply(Operation::kSubtract, a, b); }
  int product(int a, int b) { return apply(Operation::kMultiply, a, b); }
  int multiple(double factor, int a) { return product(literal(factor), a); }

  int copy(const BoundExpression& expression) {
    const int offset = static_cast<int>(nodes_.size());
    for (ExpressionTree::Node node : expression.nodes) {
      if (node.operation != Operation::kParameter) {
        for (int& operand : node.operands) {
          operand += operand < 0 ? 0 : offset;
        }
      }
      nodes_.push_back(node);
    }
    return static_cast<int>(nodes_.size()) - 1;
  }

 private:
  int add(const ExpressionTree::Node& node) {
    nodes_.push_back(node);
    return static_cast<int>(nodes_.size()) - 1;
  }

  CurveExpansion::Nodes& nodes_;
};

/// 2 a b / (a + b), 0 where they differ in sign.
int writeHarmonicMean(NodeWriter& write, int a, int b) {
  const int zero = write.literal(0.0), both = write.product(a, b), sum = write.sum(a, b);
  const int alike = write.apply(Operation::kLess, zero, both);
  const int divisor = write.apply(Operation::kSelect, alike, sum, write.literal(1.0));
  const int mean = write.apply(Operation::kDivide, write.multiple(2.0, both), divisor);
  return write.apply(Operation::kSelect, alike, mean, zero);
}

/// `rises`: from knot to knot.
Places writeMonotoneSlopes(NodeWriter& write, const Places& rises) {
  const std::size_t last = rises.size();
  Places slopes(last + 1, rises.front());
  for (std::size_t i = 1; i < last; ++i) {
    slopes[i] = writeHarmonicMean(write, rises[i - 1], rises[i]);
  }
  if (last > 1) {
    slopes[0] = write.difference(write.multiple(2.0, rises.front()), slopes[1]);
    slopes[last] = write.difference(write.multiple(2.0, rises.back()), slopes[last - 1]);
  }
  return slopes;
}

/// The tridiagonal equations of the spline, solved from the first to the last and back; their matrix is one
/// of numbers: 1 1 / 1 4 1 / ... / 1 1.
Places writeSplineSlopes(NodeWriter& write, const Places& rises) {
  const std::size_t last = rises.size();
  if (last == 1) {
    return {rises[0], rises[0]};
  }
  std::vector<double> pivots{1.0};
  Places right{write.multiple(2.0, rises.front())};
  for (std::size_t i = 1; i <= last; ++i) {
    const int own = i == last ? write.multiple(2.0, rises.back())
                              : write.multiple(3.0, write.sum(rises[i - 1], rises[i]));
    right.push_back(write.difference(own, write.multiple(1.0 / pivots.back(), right.back())));
    pivots.push_back((i == last ? 1.0 : 4.0) - 1.0 / pivots.back());
  }
  Places slopes(last + 1);
  slopes[last] = write.multiple(1.0 / pivots[last], right[last]);
  for (std::size_t i = last; i-- > 0;) {
    slopes[i] = write.multiple(1.0 / pivots[i], write.difference(right[i], slopes[i + 1]));
  }
  return slopes;
}

/// The coefficient that belongs to the interval of `at`, in units of the distance of knots.
int writeChoice(NodeWriter& write, int at, const Places& coefficients) {
  int chosen = coefficients.back();
  for (std::size_t i = coefficients.size() - 1; i-- > 0;) {
    const int before = write.apply(Operation::kLess, at, write.literal(static_cast<double>(i + 1)));
    chosen = write.apply(Operation::kSelect, before, coefficients[i], chosen);
  }
  return chosen;
}

}  // namespace

int CurveExpansion::append(Nodes& nodes, int argument) const {
  NodeWriter write(nodes);
  Places values, rises;
  for (const BoundExpression& value : values_) {
    values.push_back(write.copy(value));
  }
  const std::size_t last = values.size() - 1;
  for (std::size_t i = 0; i < last; ++i) {
    rises.push_back(write.difference(values[i + 1], values[i]));
  }
  const Places slopes = monotone_ ? writeMonotoneSlopes(write, rises) : writeSplineSlopes(write, rises);
  // v + t (s + t (square + t cube)) on each interval
  Places starts, squares, cubes;
  for (std::size_t i = 0; i < last; ++i) {
    const int both = write.sum(slopes[i], slopes[i + 1]);
    const int triple = write.difference(write.multiple(3.0, rises[i]), both);
    starts.push_back(write.literal(static_cast<double>(i)));
    squares.push_back(write.difference(triple, slopes[i]));
    cubes.push_back(write.difference(both, write.multiple(2.0, rises[i])));
  }
  const double distance = (range_.upper - range_.lower) / static_cast<double>(last);
  const int at = write.multiple(1.0 / distance, write.difference(argument, write.literal(range_.lower)));
  const int zero = write.literal(0.0), end = write.literal(static_cast<double>(last));
  const int within = write.apply(Operation::kMin, write.apply(Operation::kMax, at, zero), end);
  const int t = write.difference(within, writeChoice(write, at, starts));
  int value = writeChoice(write, at, cubes);
  for (const Places& next :
       {squares, Places(slopes.begin(), slopes.end() - 1), Places(values.begin(), values.end() - 1)}) {
    value = write.sum(writeChoice(write, at, next), write.product(t, value));
  }
  const int before = write.product(slopes.front(), write.apply(Operation::kMin, at, zero));
  const int beyond = write.apply(Operation::kMax, write.difference(at, end), zero);
  return write.sum(value, write.sum(before, write.product(slopes.back(), beyond)));
}

std::vector<Expression> listKnotParameters(const CurveSpec& curve) {
  std::vector<Expression> values;
  for (int i = 1; i <= curve.knots.value_or(0); ++i) {
    values.push_back({fmt::format("{}_{}", curve.name.text, i), curve.name.where});
  }
  return values;
}

}  // namespace twinmap
