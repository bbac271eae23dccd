#include "kernels/lanes/program/recorder.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "kernels/lanes/program/differentiate.hpp"
#include "kernels/lanes/program/real.hpp"
#include "tests/kernels/lanes/program/walk.hpp"

namespace twinmap::program {
namespace {

using testing::Inputs;
using testing::walk;

TEST(Recorder, FindsEqualTermsAgain) {
  Recorder r;
  const Symbol x = r.state(0), y = r.state(1);
  EXPECT_EQ((x * y + 2.0).getNode(), (2.0 + y * x).getNode());
  EXPECT_EQ(sin(x).getNode(), sin(r.state(0)).getNode());
  EXPECT_NE((x - y).getNode(), (y - x).getNode());
  EXPECT_NE(r.state(0).getNode(), r.parameter(0).getNode());
}

TEST(Recorder, LiteralsFoldAndZerosVanish) {
  Recorder r;
  const Symbol x = r.state(0);
  EXPECT_TRUE((Symbol(2.0) * 3.0 + 1.0).isLiteral(7.0));
  EXPECT_TRUE((x * 0.0).isLiteral(0.0));
  EXPECT_TRUE((0.0 / x).isLiteral(0.0));
  EXPECT_TRUE((x - x).isLiteral(0.0));
  EXPECT_TRUE(pow(x, 0.0).isLiteral(1.0));
  for (const Symbol& same : {x + 0.0, 0.0 + x, x - 0.0, x * 1.0, x / 1.0, -(-x), 0.0 - (-x), pow(x, 1.0),
                             x * -1.0 * -1.0, select(1.0, x, 5.0), select(r.time(), x, x)}) {
    EXPECT_EQ(same.getNode(), x.getNode());
  }
  EXPECT_EQ(r.getNodes().size(), 3u) << "x, -x and t";
}

TEST(Recorder, SignsMoveOutOfProductsAndIntoSums) {
  Recorder r;
  const Symbol x = r.state(0), y = r.state(1);
  EXPECT_EQ(((-x) * (-y)).getNode(), (x * y).getNode());
  EXPECT_EQ((x + (-y)).getNode(), (x - y).getNode());
  EXPECT_EQ((x - (-y)).getNode(), (x + y).getNode());
  EXPECT_EQ((-(x - y)).getNode(), (y - x).getNode());
  EXPECT_EQ(sin(-x).getNode(), (-sin(x)).getNode());
  EXPECT_EQ(cos(-x).getNode(), cos(x).getNode());
}

TEST(Recorder, FactorsKnownEarlyAreGathered) {
  Recorder r;
  const Symbol p = r.parameter(0), q = r.parameter(1), x = r.state(0);
  const Node product = r.getNode(p * (x * q));
  EXPECT_EQ(product.level, Level::kEvaluation);
  EXPECT_EQ(std::min(product.a, product.b), std::min(x.getNode(), (p * q).getNode()));
  EXPECT_EQ(r.getNode(x / p).operation, Operation::kMultiply);
  EXPECT_EQ(r.getNode(p / x).operation, Operation::kDivide);
}

TEST(Recorder, KnowsHowOftenAValueChanges) {
  Recorder r;
  EXPECT_EQ(r.getLevel(3.0), Level::kLiteral);
  EXPECT_EQ(r.getLevel(r.parameter(0) * 2.0), Level::kParameter);
  EXPECT_EQ(r.getLevel(r.parameter(0) * r.phaseInput(1)), Level::kPhase);
  EXPECT_EQ(r.getLevel(sin(r.time()) * r.phaseInput(1)), Level::kEvaluation);
}

TEST(Recorder, IntegerPowersAreProducts) {
  for (int n = -16; n <= 16; ++n) {
    Recorder r;
    const double value = walk(r, {pow(r.state(0), n)}, {0.0, {-1.3}, {}, {}})[0];
    EXPECT_NEAR(value / std::pow(-1.3, n), 1.0, 1e-15 * 16);
    for (const Node& node : r.getNodes()) {
      EXPECT_NE(node.operation, Operation::kPow);
    }
  }
}

/// One expression of doubles and symbols, with every operator and most functions.
template <typename T>
T calcMixture(T t, T x, T y, T p) {
  using namespace real;
  T sum = x * y - t / (2.0 + y * y);
  sum += sqrt(1.0 + x * x) * abs(y);
  sum -= select(less(x, y), sin(x * p), cos(y) * tan(0.3 * x));
  sum *= exp(-p) + log(2.0 + x) + log2(3.0 + x) + log10(4.0 + x);
  sum /= 1.0 + pow(p, x) + min(x, y) * max(x, p);
  sum += atan2(y, x + 3.0) + asin(0.1 * x) + acos(0.1 * y) + atan(x);
  sum += sinh(x) * cosh(y) - tanh(p) + asinh(x) + acosh(2.0 + p) + atanh(0.2 * x);
  return sum + floor(x) + rint(3.0 * y) + sign(y) + both(less(x, y), lessOrEqual(p, 1.0)) +
         either(equal(x, y), notEqual(x, p)) - (-x);
}

TEST(Symbol, ComputesWhatADoubleDoes) {
  Recorder r;
  const Symbol mixture = calcMixture<Symbol>(r.time(), r.state(0), r.state(1), r.parameter(0));
  for (const double x : {-0.7, 0.2, 0.9}) {
    for (const double y : {-0.4, 0.2, 1.3}) {
      const double expected = calcMixture<double>(0.6, x, y, 0.8);
      EXPECT_NEAR(walk(r, {mixture}, {0.6, {x, y}, {0.8}, {}})[0], expected,
                  1e-14 * std::abs(expected) + 1e-15);
    }
  }
}

/// d f / d x by a central difference of order 4; its error is near 1e-12 for functions of order one.
double differentiateNumerically(const std::function<double(double)>& f, double x) {
  const double h = 1e-3;
  return (8.0 * (f(x + h) - f(x - h)) - (f(x + 2 * h) - f(x - 2 * h))) / (12.0 * h);
}

TEST(Derivative, IsTheLimitOfDifferences) {
  Recorder r;
  const Symbol t = r.time(), x = r.state(0), y = r.state(1), p = r.parameter(0);
  const auto jacobian = calcJacobian({calcMixture<Symbol>(t, x, y, p)}, {t, x, y, p});
  for (const double at_x : {-0.7, 0.23, 0.9}) {
    for (const double at_y : {-0.41, 0.2, 1.3}) {
      const Inputs inputs{0.6, {at_x, at_y}, {0.8}, {}};
      const std::vector<double> values{0.6, at_x, at_y, 0.8};
      for (int j = 0; j < 4; ++j) {
        const double expected = differentiateNumerically(
            [&](double value) {
              std::vector<double> v = values;
              v[j] = value;
              return calcMixture<double>(v[0], v[1], v[2], v[3]);
            },
            values[j]);
        EXPECT_NEAR(walk(r, {jacobian[j][0]}, inputs)[0], expected, 1e-8) << "variable " << j;
      }
    }
  }
}

TEST(Derivative, AlongADirectionSumsTheSeeds) {
  Recorder r;
  const Symbol x = r.state(0), y = r.state(1), s = r.state(2);
  const Symbol tangent = calcTangents({x * x * y}, {{x, s}, {y, 3.0}})[0];
  EXPECT_DOUBLE_EQ(walk(r, {tangent}, {0.0, {2.0, 5.0, 7.0}, {}, {}})[0], 2 * 2.0 * 5.0 * 7.0 + 3.0 * 4.0);
}

TEST(Derivative, OfWhatDoesNotDependOnTheVariableIsALiteralZero) {
  Recorder r;
  const auto columns = calcJacobian({r.state(1) * r.parameter(0), 3.0, floor(r.state(0))}, {r.state(0)});
  for (const Symbol& entry : columns[0]) {
    EXPECT_TRUE(entry.isLiteral(0.0));
  }
}

}  // namespace
}  // namespace twinmap::program
