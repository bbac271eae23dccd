#include "framework/experiment/expression/expression.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "framework/base/text/number_text.hpp"

namespace twinmap {
namespace {

TEST(Expression, ReadsTheScopesCurrentValues) {
  ExpressionScope scope;
  const int m = scope.define("m", 3.0);
  const int length = scope.define("L", 2.0);
  const CompiledExpression inertia = scope.compile({"m * L^2 / 12", {}});
  EXPECT_DOUBLE_EQ(inertia.calc(), 1.0);
  scope.upd(m) = 6.0;
  scope.upd(length) = 4.0;
  EXPECT_DOUBLE_EQ(inertia.calc(), 8.0);
}

TEST(Expression, KeepsItsNamesWhenOthersAreDefinedLater) {
  ExpressionScope scope;
  const int a = scope.define("a", 1.0);
  const CompiledExpression twice = scope.compile({"2 * a", {}});
  for (int i = 0; i < 100; ++i) {
    scope.define("b" + std::to_string(i));
  }
  scope.upd(a) = 5.0;
  EXPECT_DOUBLE_EQ(twice.calc(), 10.0);
}

TEST(Expression, KnowsFunctionsComparisonsAndPi) {
  ExpressionScope scope;
  scope.define("x", -2.0);
  EXPECT_DOUBLE_EQ(scope.compile({"abs(x) + sign(x) + max(1, 3)", {}}).calc(), 4.0);
  EXPECT_DOUBLE_EQ(scope.compile({"x < 0 ? cos(pi) : 1", {}}).calc(), -1.0);
  EXPECT_DOUBLE_EQ(scope.compile({"x == -2 ? 1 : 0", {}}).calc(), 1.0);
  EXPECT_TRUE(std::isinf(scope.compile({"1 / (x + 2)", {}}).calc()));
}

TEST(Expression, LiteralsAreNotParsedByMuparser) {
  ExpressionScope scope;
  const CompiledExpression number = scope.compile({"-1.5e-3", {}});
  EXPECT_TRUE(number.isLiteral());
  EXPECT_EQ(number.calc(), -1.5e-3);
}

TEST(Expression, ErrorsNamePlaceValueAndRule) {
  ExpressionScope scope;
  scope.define("stiffness", 1.0);
  const SourceLocation where{"f.yaml", 3, 7, "system.springs[0].stiffness"};
  const auto get_error = [&](const std::string& text) -> std::string {
    try {
      scope.compile({text, where});
    } catch (const ExperimentError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(
      get_error("2 * stifness"),
      "f.yaml:3:7: system.springs[0].stiffness: '2 * stifness' uses the unknown name 'stifness'; did you "
      "mean 'stiffness'?");
  EXPECT_NE(get_error("stiffness = 3").find("must not assign"), std::string::npos);
  EXPECT_NE(get_error("2 *").find("is not a valid expression"), std::string::npos);
  EXPECT_NE(get_error("(2").find("is not a valid expression"), std::string::npos);
}

TEST(Expression, MayBeLongOrDeepButNotEndless) {
  std::string sum = "1", nested = "1";
  for (int i = 0; i < 1000; ++i) {
    sum += "+1";
    nested = "(" + nested + ")";
  }
  ExpressionScope scope;
  EXPECT_EQ(scope.compile({sum, {}}).calc(), 1001.0);
  EXPECT_EQ(scope.compile({nested, {}}).calc(), 1.0);
  for (const char character : {'x', '1', '(', '+'}) {
    EXPECT_THROW(scope.compile({std::string(100000, character), {}}), ExperimentError) << character;
  }
}

TEST(NumberText, IsShortestAndReadsBackAsTheSameNumber) {
  EXPECT_EQ(toText(0.1), "0.1");
  EXPECT_EQ(toText(1.3e-4), "0.00013");
  for (const double value : {1.0 / 3.0, 5e-324, 1.7976931348623157e308, -2.5e-17}) {
    double read = 0.0;
    ASSERT_TRUE(parseLiteral(toText(value), read));
    EXPECT_EQ(read, value);
  }
}

TEST(NumberText, OnlyFiniteDecimalNumbersAreLiterals) {
  double value = 0.0;
  for (const char* text : {"", "nan", "inf", "1e999", "0x10", "1.5 ", "1,5", "--1", "k"}) {
    EXPECT_FALSE(parseLiteral(text, value)) << text;
  }
  EXPECT_TRUE(parseLiteral("+2", value));
}

}  // namespace
}  // namespace twinmap
