#include "framework/simulation/sensors.hpp"

#include <gtest/gtest.h>

namespace twinmap {
namespace {

TEST(Sensors, ShowGainTimesTheQuantityOfAModelFromElsewherePlusOffset) {
  ModelSpec model;
  model.parameters.emplace_back();
  model.parameters.front().name.text = "b";
  model.outputs.resize(2);
  model.outputs[0].gain = {"2 * b", {}};
  model.outputs[0].offset = {"b", {}};
  ModelNumbers numbers(model);
  numbers.update(Eigen::VectorXd::Constant(1, 0.5));
  Eigen::VectorXd response(4), expected(4);
  response << 1.0, 2.0, 3.0, 4.0;
  expected << 1.5, 2.5, 3.0, 4.0;
  applySensors(model, numbers, response);
  EXPECT_EQ(response, expected);
}

}  // namespace
}  // namespace twinmap
