#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "framework/base/text/number_text.hpp"
#include "framework/experiment/expression/named_values.hpp"
#include "kernels/lanes/program/symbol.hpp"

namespace twinmap {
namespace {

std::string getError(const NamedValues<double>& values, const std::string& text) {
  try {
    values.bind({text, {"f.yaml", 3, 7, "system.springs[0].stiffness"}});
  } catch (const ExperimentError& error) {
    return error.what();
  }
  return "";
}

TEST(Expression, ReadsTheCurrentValues) {
  NamedValues<double> values;
  const int m = values.define("m", 3.0);
  const int length = values.define("L", 2.0);
  const BoundExpression inertia = values.bind({"m * L^2 / 12", {}});
  EXPECT_DOUBLE_EQ(values.calc(inertia), 1.0);
  values.upd(m) = 6.0;
  values.upd(length) = 4.0;
  EXPECT_DOUBLE_EQ(values.calc(inertia), 8.0);
}

TEST(Expression, KeepsItsNamesWhenOthersAreDefinedLater) {
  NamedValues<double> values;
  const int a = values.define("a", 1.0);
  const BoundExpression twice = values.bind({"2 * a", {}});
  for (int i = 0; i < 100; ++i) {
    values.define("b" + std::to_string(i));
  }
  values.upd(a) = 5.0;
  EXPECT_DOUBLE_EQ(values.calc(twice), 10.0);
}

TEST(Expression, KnowsFunctionsComparisonsAndPi) {
  NamedValues<double> values;
  values.define("x", -2.0);
  const auto calc = [&](const std::string& text) { return values.calc(Expression{text, {}}); };
  EXPECT_DOUBLE_EQ(calc("abs(x) + sign(x) + max(1, 3)"), 4.0);
  EXPECT_DOUBLE_EQ(calc("x < 0 ? cos(pi) : 1"), -1.0);
  EXPECT_DOUBLE_EQ(calc("x == -2 ? 1 : 0"), 1.0);
  EXPECT_DOUBLE_EQ(calc("floor(-2.5) + rint(2.5) + _pi - pi"), 0.0);
  EXPECT_TRUE(std::isinf(calc("1 / (x + 2)")));
}

/// The lines of the golden file: value, tab, expression.
std::vector<std::pair<double, std::string>> readGolden() {
  std::ifstream file(std::string(TWINMAP_SOURCE_DIR) + "/tests/framework/experiment/expressions_golden.tsv");
  std::vector<std::pair<double, std::string>> golden;
  for (std::string line; std::getline(file, line);) {
    if (line[0] != '#') {
      golden.emplace_back(std::stod(line), line.substr(line.find('\t') + 1));
    }
  }
  return golden;
}

template <class S>
NamedValues<S> makeGoldenValues() {
  NamedValues<S> values;
  values.define("x", 0.7);
  values.define("k_1", -1.3);
  values.define("Y2", 2.5);
  values.define("theta_dot", 0.0);
  return values;
}

TEST(Expression, HasTheValuesOfAnotherImplementation) {
  const NamedValues<double> values = makeGoldenValues<double>();
  const auto golden = readGolden();
  ASSERT_GT(golden.size(), 390u);
  for (const auto& [expected, text] : golden) {
    const double value = values.calc(Expression{text, {}});
    if (std::isfinite(expected)) {
      EXPECT_NEAR(value, expected, 1e-9 * (1.0 + std::abs(expected))) << text;
    } else {
      EXPECT_FALSE(std::isfinite(value)) << text;
    }
  }
}

TEST(Expression, HasTheBitsOfARecordedProgram) {
  const NamedValues<double> values = makeGoldenValues<double>();
  const NamedValues<program::Symbol> symbols =
      makeGoldenValues<program::Symbol>();  // literals, so that all folds
  for (const auto& [expected, text] : readGolden()) {
    const double value = values.calc(Expression{text, {}});
    const program::Symbol symbol = symbols.calc(Expression{text, {}});
    ASSERT_TRUE(symbol.isLiteral()) << text;
    EXPECT_TRUE(symbol.getLiteral() == value || (std::isnan(value) && std::isnan(symbol.getLiteral())))
        << text;
  }
}

TEST(Expression, NamesAreInOrderOfAppearance) {
  EXPECT_EQ(getUsedNames({"k_1 * sin(x) + k_1 * pi", {}}), (std::vector<std::string>{"k_1", "x"}));
}

TEST(Expression, ConstantsAndFunctionsCannotNameAnythingElse) {
  for (const char* name : {"t", "pi", "_pi", "_e", "sin", "ln", "atan2", "max", "avg"}) {
    EXPECT_TRUE(isReservedName(name)) << name;
  }
  EXPECT_FALSE(isReservedName("theta"));
}

TEST(Expression, ErrorsNamePlaceValueRuleAndCharacter) {
  NamedValues<double> values;
  values.define("stiffness", 1.0);
  values.define("x", 1.0);
  EXPECT_EQ(
      getError(values, "2 * stifness"),
      "f.yaml:3:7: system.springs[0].stiffness: '2 * stifness' uses the unknown name 'stifness'; did you "
      "mean 'stiffness'?");
  EXPECT_EQ(
      getError(values, "2 * v"),
      "f.yaml:3:7: system.springs[0].stiffness: '2 * v' uses the unknown name 'v' (known: stiffness, x)");
  EXPECT_NE(getError(values, "stiffness = 3").find("must not assign"), std::string::npos);
  const std::vector<std::pair<std::string, std::string>> wrong{
      {"", "a number, a name or '(' is missing at character 1"},
      {"2 *", "a number, a name or '(' is missing at character 4"},
      {"x + * 2", "a number, a name or '(' is missing at character 5"},
      {"(2", "')' is missing at character 3"},
      {"x)", "an operator is missing at character 2"},
      {"x x", "an operator is missing at character 3"},
      {"1, 2", "an operator is missing at character 2"},
      {"x # 2", "an operator is missing at character 3"},
      {"x ? 1", "':' is missing at character 6"},
      {"2x", "what is not a number begins with a digit (a unit is not written here) at character 1"},
      {"1.5 kg", "an operator is missing (a unit is not written here) at character 5"},
      {"x ** 3", "a power is written x^2, not x**2, at character 4"},
      {"1 + f(x)", "there is no function 'f' at character 5"},
      {"sin(x, 2)", "'sin' takes one operand, not 2, at character 1"},
      {"atan2(x)", "'atan2' takes two operands, not 1, at character 1"}};
  for (const auto& [text, what] : wrong) {
    EXPECT_NE(getError(values, text).find("is not a valid expression: " + what), std::string::npos)
        << text << ": " << getError(values, text);
  }
}

TEST(Expression, MayBeLongOrDeepButNotEndless) {
  std::string sum = "1", nested = "1";
  for (int i = 0; i < 1000; ++i) {
    sum += "+1";
    nested = "(" + nested + ")";
  }
  NamedValues<double> values;
  values.define("x", 1.0);
  EXPECT_EQ(values.calc(Expression{sum, {}}), 1001.0);
  EXPECT_EQ(values.calc(Expression{nested, {}}), 1.0);
  EXPECT_NE(getError(values, std::string(1500, '(') + "x" + std::string(1500, ')')).find("1024 levels"),
            std::string::npos);
  for (const char character : {'x', '1', '(', '+'}) {
    EXPECT_NE(getError(values, std::string(100000, character)).find("at most 4000 characters"),
              std::string::npos);
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
