#include "framework/simulation/number_evaluator.hpp"

#include <gtest/gtest.h>

namespace twinmap {
namespace {

TEST(NumberEvaluator, FollowsTheScope) {
  ExpressionScope scope;
  scope.define("m", 2.0);
  NumberEvaluator numbers(scope);
  const Expression expression{"m * 3", {}};
  const std::string owner = "body 'a'";
  EXPECT_EQ(numbers.calc(expression, {owner, "mass", "kg"}), 6.0);
  scope.upd(0) = -1.0;
  EXPECT_EQ(numbers.calc(expression, {owner, "mass", "kg"}), -3.0);
}

TEST(NumberEvaluator, FailuresNameOwnerQuantityValueAndRule) {
  ExpressionScope scope;
  scope.define("m", 0.0);
  NumberEvaluator numbers(scope);
  const Expression mass{"m", {}}, inverse{"1 / m", {}};
  const std::string owner = "body 'a'";
  const auto getMessage = [&](const auto& calculate) -> std::string {
    try {
      calculate();
    } catch (const SimulationFailure& failure) {
      return failure.what();
    }
    return "";
  };
  EXPECT_EQ(getMessage([&] {
              numbers.calcPositive(mass, {owner, "mass", "kg"});
            }),
            "body 'a': mass = 0 kg must be positive");
  EXPECT_EQ(getMessage([&] {
              numbers.calc(inverse, {owner, "ratio", ""});
            }),
            "body 'a': ratio = inf must be finite");
}

TEST(NumberEvaluator, UnknownNamesAreWrongInput) {
  ExpressionScope scope;
  NumberEvaluator numbers(scope);
  const Expression expression{"mass", {}};
  const std::string owner = "body 'a'";
  EXPECT_THROW(numbers.calc(expression, {owner, "mass", "kg"}), ExperimentError);
}

}  // namespace
}  // namespace twinmap
