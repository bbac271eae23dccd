// Expressions over any scalar against muParser.

#include "framework/models/mechanism/equations/calc_expression.hpp"

#include <gtest/gtest.h>

#include <array>
#include <random>

#include "framework/experiment/expression/expression.hpp"

namespace twinmap {
namespace {

const std::array<const char*, 4> kNames{"x", "k_1", "Y2", "theta_dot"};
constexpr std::array<double, 4> kValues{0.7, -1.3, 2.5, 0.0};

/// The value by muParser.
double calcReference(const std::string& text) {
  ExpressionScope scope;
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    scope.define(kNames[i], kValues[i]);
  }
  return scope.compile({text, {}}).calc();
}

double calc(const std::string& text) {
  const ExpressionTree tree = parseExpression(text);
  std::vector<double> values;
  for (const std::string& name : tree.names) {
    const auto at = std::find(kNames.begin(), kNames.end(), name);
    values.push_back(kValues[static_cast<std::size_t>(at - kNames.begin())]);
  }
  return equations::calcExpression(tree, values);
}

void expectSame(const std::string& text) {
  const double expected = calcReference(text), value = calc(text);
  if (std::isnan(expected)) {  // muParser's asinh(-inf), too
    EXPECT_FALSE(std::isfinite(value)) << text << " = " << value;
  } else if (std::isinf(expected)) {
    EXPECT_EQ(value, expected) << text;
  } else {
    // products for powers, and muParser's own rearrangements, round differently
    EXPECT_NEAR(value, expected, 1e-9 * (1.0 + std::abs(expected))) << text;
  }
}

/// Drawn from left to right, so that every compiler gets the same.
class RandomExpression {
 public:
  explicit RandomExpression(unsigned seed) : generator_(seed) {}

  std::string make(int depth) {
    text_.clear();
    add(depth);
    return text_;
  }

 private:
  void add(int depth) {
    if (depth == 0) {
      pick({"x", "k_1", "Y2", "theta_dot", "2", "0.5", "3.25e-1", "1E1", ".75", "4.", "pi", "_pi", "_e"});
      return;
    }
    switch (generator_() % 9) {
      case 0:
        pick({"-", "+", "- "});
        addOperand(depth);
        break;
      case 1:
        pick({"sin",   "cos", "tan", "asin", "acos", "atan",  "sinh", "cosh", "tanh", "asinh", "acosh",
              "atanh", "exp", "log", "ln",   "log2", "log10", "sqrt", "abs",  "sign", "rint"});
        addList(depth, {"(", ")"});
        break;
      case 2:
        pick({"min", "max", "sum", "avg"});
        addList(depth, {"(", ", ", ",", ")"});
        break;
      case 3:
        addList(depth, {"atan2(", ",", ")"});
        break;
      case 4:
        addList(depth, {"(", " ? ", " : ", ")"});
        break;
      case 5:  // with a variable on the left: of two constants muParser takes the whole parts
        text_ += "theta_dot*2 + ";
        add(depth - 1);
        pick({" && ", "||"});
        addOperand(depth);
        break;
      default:
        addOperand(depth);
        pick({"+", "-", "*", "/", " ^ ", "+", " - ", "*", "<", "<=", ">", ">=", "==", "!="});
        addOperand(depth);
    }
  }

  void pick(const std::vector<std::string>& choices) { text_ += choices[generator_() % choices.size()]; }

  /// Expressions between the separators.
  void addList(int depth, const std::vector<std::string>& separators) {
    text_ += separators.front();
    for (std::size_t i = 1; i < separators.size(); ++i) {
      add(depth - 1);
      text_ += separators[i];
    }
  }

  /// Half of the operands stand without parentheses, so that precedence decides.
  void addOperand(int depth) {
    const bool bare = generator_() % 2 == 0;
    text_ += bare ? "" : "(";
    add(depth - 1);
    text_ += bare ? "" : ")";
  }

  std::mt19937 generator_;
  std::string text_;
};

TEST(ExpressionTree, AgreesWithMuparserOnRandomExpressions) {
  int compared = 0;
  for (unsigned seed = 0; seed < 6000; ++seed) {
    const std::string text = RandomExpression(seed).make(1 + static_cast<int>(seed % 4));
    try {
      calcReference(text);
    } catch (const ExperimentError&) {
      continue;  // two signs in a row and the like, which muParser refuses
    }
    expectSame(text);
    ++compared;
  }
  EXPECT_GT(compared, 4000);
}

TEST(ExpressionTree, BindsAsMuparserDoes) {
  for (const char* text : {"-x^2",
                           "-k_1^2",
                           "2^3^2",
                           "2^-3",
                           "2^-x*3",
                           "x-k_1-Y2",
                           "x/k_1/Y2",
                           "x-k_1+Y2",
                           "-x*Y2",
                           "1+2<3+1",
                           "x<1 && k_1<0 || 0",
                           "0 || 1 && 0",
                           "x > 0 ? 1 : x < 0 ? 2 : 3",
                           "1 ? 2 : 0 ? 3 : 4",
                           "x < k_1 < Y2",
                           "1 == 1 != 0",
                           "-(-x)",
                           "+x",
                           "theta_dot^0",
                           "sum(x)",
                           "min(x)",
                           "avg(x,Y2)",
                           "((((x))))",
                           "2*-x",
                           "x^0.5",
                           "k_1^3",
                           "k_1^-3",
                           "Y2^16",
                           "Y2^17",
                           "-1^0.5",
                           "rint(-2.5)",
                           "rint(2.5)"}) {
    expectSame(text);
  }
}

TEST(ExpressionTree, KeepsItsNamesInOrderOfAppearance) {
  EXPECT_EQ(parseExpression("k_1 * sin(x) + k_1 * pi").names, (std::vector<std::string>{"k_1", "x"}));
}

TEST(ExpressionTree, RefusesWhatItDoesNotKnow) {
  for (const char* text :
       {"", "x +", "(x", "x)", "x y", "1, 2", "f(x)", "sin(x, 2)", "2x", "x ? 1", "x # 2"}) {
    EXPECT_THROW(parseExpression(text), UnknownSyntax) << text;
  }
  EXPECT_THROW(parseExpression(std::string(1000, '(') + "x" + std::string(1000, ')')), UnknownSyntax);
}

}  // namespace
}  // namespace twinmap
