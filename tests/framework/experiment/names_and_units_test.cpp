#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "framework/base/text/nearest_name.hpp"
#include "framework/experiment/check/check_scope.hpp"
#include "framework/experiment/expression/units.hpp"
#include "framework/experiment/files/experiment_file.hpp"
#include "tests/framework/experiment/experiments.hpp"

namespace twinmap {
namespace {

TEST(SuggestName, FindsTypingErrorsOnly) {
  const std::vector<std::string> names{"stiffness", "damping", "mass"};
  EXPECT_EQ(suggestName("stifness", names), "; did you mean 'stiffness'?");
  EXPECT_EQ(suggestName("MASS", names), "; did you mean 'mass'?");
  EXPECT_EQ(suggestName("temperature", names), "");
  EXPECT_EQ(suggestName(std::string(1000000, 'x'), names), "");
}

TEST(Units, OfTorquesAndAccelerationsAreReadAsTheyAreWritten) {
  EXPECT_NEAR(calcUnitConversion("Nm", "N m", {}).factor, 1.0, 1e-12);
  EXPECT_NEAR(calcUnitConversion("mNm", "N m", {}).factor, 1e-3, 1e-15);
  EXPECT_NEAR(calcUnitConversion("Ncm", "N m", {}).factor, 1e-2, 1e-14);
  EXPECT_NEAR(calcUnitConversion("g", "m/s2", {}).factor, 9.80665, 1e-12);
  EXPECT_NEAR(calcUnitConversion("g", "kg", {}).factor, 1e-3, 1e-15);
  EXPECT_TRUE(isUnit("ms"));
  EXPECT_FALSE(isUnit("left"));
  EXPECT_FALSE(isUnit("1"));
}

TEST(Units, DimensionsFollowFromTheUnit) {
  EXPECT_EQ(parseUnit("N s/m", {}), (Dimension{{"kg", 1}, {"s", -1}}));
  EXPECT_EQ(parseUnit("N m s/rad", {}), (Dimension{{"kg", 1}, {"m", 2}, {"s", -1}}));
  EXPECT_EQ(parseUnit("kg m^2", {}), parseUnit("kg m2", {}));
  EXPECT_EQ(parseUnit("N m/rad", {}), parseUnit("J", {}));
  EXPECT_EQ(parseUnit("Hz", {}), (Dimension{{"s", -1}}));
  EXPECT_EQ(parseUnit("N/m^1.5", {}), (Dimension{{"kg", 1}, {"m", -0.5}, {"s", -2}}));
  EXPECT_EQ(parseUnit("N m^-1.0", {}), (Dimension{{"kg", 1}, {"s", -2}}));
  EXPECT_THROW(parseUnit("N/mm^1.5", {}), ExperimentError);
  EXPECT_TRUE(parseUnit("rad", {}).empty());
  EXPECT_TRUE(parseUnit("-", {}).empty());
  EXPECT_TRUE(parseUnit("1", {}).empty());
}

TEST(Units, AreDescribedAsEngineersWriteThem) {
  EXPECT_EQ(describeUnit(parseUnit("kg/s2", {})), "N/m");
  EXPECT_EQ(describeUnit(parseUnit("rad", {})), "1");
  EXPECT_EQ(describeUnit({{"kg", 1.0}, {"s", -3.5}}), "kg s-3.5");
}

TEST(Units, RefusesWhatIsNoCoherentUnit) {
  for (const char* unit : {"N/mm", "mm", "deg", "kN", "g", "furlongish", "N//m", "degC", "%"}) {
    EXPECT_THROW(parseUnit(unit, {}), ExperimentError) << unit;
  }
}

class CheckScopeTest : public testing::Test {
 protected:
  CheckScopeTest() {
    scope_.define({"k", {}}, parseUnit("N/m", {}), 10.0);
    scope_.define({"L", {}}, parseUnit("m", {}), 0.5);
    scope_.define({"m", {}}, parseUnit("kg", {}), 2.0);
    scope_.define({"x", {}}, std::nullopt, 3.0);
  }
  CheckScope scope_;
};

TEST_F(CheckScopeTest, AcceptsExpressionsThatComeOutInTheUnit) {
  EXPECT_DOUBLE_EQ(scope_.check(Expression{"k", {}}, "N/m"), 10.0);
  EXPECT_NO_THROW(scope_.check(Expression{"k*L", {}}, "N"));
  EXPECT_NO_THROW(scope_.check(Expression{"m*L^2/12", {}}, "kg m2"));
  EXPECT_NO_THROW(scope_.check(Expression{"sqrt(k/m)", {}}, "1/s"));
}

TEST_F(CheckScopeTest, RefusesExpressionsThatContradictTheUnit) {
  EXPECT_THROW(scope_.check(Expression{"k", {}}, "kg"), ExperimentError);
  EXPECT_THROW(scope_.check(Expression{"k + m", {}}, "N/m"), ExperimentError);
  EXPECT_THROW(scope_.check(Expression{"m*L^3", {}}, "kg m2"), ExperimentError);
}

TEST_F(CheckScopeTest, NumbersAndNamesWithoutUnitMayCarryAny) {
  EXPECT_NO_THROW(scope_.check(Expression{"7850*L", {}}, "kg"));
  EXPECT_NO_THROW(scope_.check(Expression{"x", {}}, "kg"));
  EXPECT_NO_THROW(scope_.check(Expression{"3.3", {}}, "kg"));
}

TEST_F(CheckScopeTest, NamedExpressionsHaveTheUnitThatTheyComeOutIn) {
  scope_.define({"force", {}}, Expression{"k * L", {}});
  scope_.define({"half", {}}, Expression{"0.5 * force", {}});
  EXPECT_NO_THROW(scope_.check(Expression{"force / m", {}}, "m/s2"));
  EXPECT_THROW(scope_.check(Expression{"force / m", {}}, "m/s"), ExperimentError);
  EXPECT_NO_THROW(scope_.check(Expression{"half", {}}, "kg"));  // its number may carry a unit
  EXPECT_THROW(scope_.define({"sum", {}}, Expression{"force + L", {}}), ExperimentError);
}

TEST_F(CheckScopeTest, WhatIsAddedHasOneUnitWhateverNumberStandsBeside) {
  for (const char* wrong : {"L - m", "1 * (L - m)", "(L - m) * 1", "2 * min(k, L) + 3", "L < m ? 1 : 2"}) {
    EXPECT_THROW(scope_.check(Expression{wrong, {}}, ""), ExperimentError) << wrong;
  }
  for (const char* right : {"1 * (L - 2 * L)", "L - 0.5", "max(L, 1e-3) + x", "m + 2 * L", "(L / L)^2 + 1"}) {
    EXPECT_NO_THROW(scope_.check(Expression{right, {}}, "")) << right;
  }
}

TEST_F(CheckScopeTest, ANumberBesideAQuantityHasItsUnitFromThereOn) {
  EXPECT_NO_THROW(scope_.check(Expression{"(k * L + 24) - k * L", {}}, ""));
  EXPECT_NO_THROW(scope_.check(Expression{"min(24, k * L) / L + k", {}}, ""));
  EXPECT_THROW(scope_.check(Expression{"(k * L + 24) + m", {}}, ""), ExperimentError);
  EXPECT_THROW(scope_.check(Expression{"min(24, k * L) + k", {}}, ""), ExperimentError);
}

TEST_F(CheckScopeTest, RefusesTakenReservedAndMalformedNames) {
  for (const char* name : {"k", "t", "pi", "sin", "2k", "a b", "a.b", "", "größe"}) {
    EXPECT_THROW(scope_.define({name, {}}, std::nullopt, 0.0), ExperimentError) << name;
  }
}

TEST(Units, AreParsedByAnyThread) {
  const Dimension expected = parseUnit("N m s/rad", {});
  std::atomic<int> wrong{0};
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back([&] {
      for (int i = 0; i < 3000; ++i) {
        wrong += parseUnit("N m s/rad", {}) == expected ? 0 : 1;
      }
    });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  EXPECT_EQ(wrong, 0);
}

TEST(ElementUnits, DoNotFollowTheCoordinateOfAnotherElement) {
  const std::string contact =
      "system.contacts=[{body: beam1, plane: {normal: [0, 1, 0]}, stiffness: c, exponent: 1.5, dissipation: "
      "w}]";
  const std::string only_torsion = "system.springs=[{coordinate: theta, stiffness: k_theta + 0*k_y/k_y}]";
  const std::string wear = "constants.w={value: 0.1, unit: s/m}";
  for (const char* springs : {"seed=1", only_torsion.c_str()}) {
    EXPECT_NO_THROW(
        loadExperiment(kTable1, {springs, "constants.c={value: 100, unit: N/m^1.5}", wear, contact}));
    EXPECT_THROW(
        loadExperiment(kTable1, {springs, "constants.c={value: 100, unit: N m/rad^1.5}", wear, contact}),
        ExperimentError);
  }
}

}  // namespace
}  // namespace twinmap
