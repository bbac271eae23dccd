#include "framework/estimation/refined/search_box.hpp"

#include <gtest/gtest.h>

namespace twinmap {
namespace {

SearchBox makeBox(double lower, double upper) {
  ParameterSpec parameter;
  parameter.bounds = {lower, upper, {}};
  return {{parameter}, {0, 1}, Eigen::VectorXd::Zero(1)};
}

TEST(SearchBox, ReachesFivePercentOfTheWidthBeyondTheBounds) {
  const SearchBox box = makeBox(10.0, 20.0);
  EXPECT_DOUBLE_EQ(box.makePoint(box.getLower())[0], 9.5);
  EXPECT_DOUBLE_EQ(box.makePoint(box.getUpper())[0], 20.5);
}

TEST(SearchBox, NeverReachesThroughZero) {
  EXPECT_DOUBLE_EQ(makeBox(0.0, 1.0).getLower()[0], -1.0);
  EXPECT_DOUBLE_EQ(makeBox(0.01, 1.0).getLower()[0], -1.0);
  EXPECT_DOUBLE_EQ(makeBox(-1.0, 0.0).getUpper()[0], 1.0);
  EXPECT_DOUBLE_EQ(makeBox(-1.0, 0.5).getUpper()[0], 1.1);
  EXPECT_DOUBLE_EQ(makeBox(-1.0, 0.5).getLower()[0], -1.1);
}

TEST(SearchBox, HoldsWhatIsNotSearched) {
  std::vector<ParameterSpec> parameters(3);
  for (ParameterSpec& parameter : parameters) {
    parameter.bounds = {0.0, 2.0, {}};
  }
  const SearchBox box(parameters, {1, 1}, Eigen::Vector4d(0.3, 0.4, 0.5, 7.0));
  EXPECT_EQ(box.makePoint(Eigen::VectorXd::Constant(1, 0.5)), Eigen::Vector4d(0.3, 1.5, 0.5, 7.0));
  EXPECT_EQ(box.normalize(Eigen::Vector4d(9.0, 1.5, 9.0, 9.0)), Eigen::VectorXd::Constant(1, 0.5));
}

}  // namespace
}  // namespace twinmap
