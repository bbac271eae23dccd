#include "framework/simulation/model_numbers.hpp"

#include <gtest/gtest.h>

#include <functional>

namespace twinmap {
namespace {

const std::string kOwner = "body 'a'";

ModelSpec makeModel() {
  ModelSpec model;
  model.parameters.emplace_back();
  model.parameters.front().name.text = "m";
  return model;
}

std::string getMessage(const std::function<void()>& calculate) {
  try {
    calculate();
  } catch (const SimulationFailure& failure) {
    return failure.what();
  }
  return "";
}

TEST(ModelNumbers, FollowTheParameters) {
  const ModelSpec model = makeModel();
  ModelNumbers numbers(model);
  const Expression expression{"m * 3", {}};
  numbers.update(Eigen::VectorXd::Constant(1, 2.0));
  EXPECT_EQ(numbers.calc(expression, {kOwner, "mass", "kg"}), 6.0);
  numbers.update(Eigen::VectorXd::Constant(1, -1.0));
  EXPECT_EQ(numbers.calc(expression, {kOwner, "mass", "kg"}), -3.0);
}

TEST(ModelNumbers, FailuresNameOwnerQuantityValueAndRule) {
  const ModelSpec model = makeModel();
  ModelNumbers numbers(model);
  numbers.update(Eigen::VectorXd::Zero(1));
  const Expression mass{"m", {}}, inverse{"1 / m", {}};
  EXPECT_EQ(getMessage([&] {
              numbers.calcPositive(mass, {kOwner, "mass", "kg"});
            }),
            "body 'a': mass = 0 kg must be positive");
  EXPECT_EQ(getMessage([&] {
              numbers.calc(inverse, {kOwner, "ratio", ""});
            }),
            "body 'a': ratio = inf must be finite");
}

TEST(ModelNumbers, UnknownNamesAreWrongInput) {
  const ModelSpec model;
  ModelNumbers numbers(model);
  const Expression expression{"mass", {}};
  EXPECT_THROW(numbers.calc(expression, {kOwner, "mass", "kg"}), ExperimentError);
}

}  // namespace
}  // namespace twinmap
