#include "framework/estimation/ridges/base_parameters.hpp"

#include <gtest/gtest.h>

#include <string>

namespace twinmap {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

ParameterSpec makeParameter(const std::string& name, double lower, double upper, const std::string& unit) {
  ParameterSpec parameter;
  parameter.name.text = name;
  parameter.bounds = {lower, upper, {}};
  parameter.unit = unit;
  return parameter;
}

/// An arm of mass m at c with the moment J about its centre of mass, which carries a tip of mass M at 0.5 m.
ModelSpec makeArm() {
  ModelSpec model;
  model.parameters = {makeParameter("m", 1.0, 3.0, "kg"), makeParameter("c", 0.1, 0.3, "m"),
                      makeParameter("J", 0.01, 0.05, "kg m2"), makeParameter("M", 0.2, 0.6, "kg"),
                      makeParameter("b", 0.0, 0.2, "N m s/rad")};
  BodySpec arm, tip;
  arm.name.text = "arm";
  arm.mass.text = "m";
  arm.center_of_mass[0].text = "c";
  arm.inertia.moments = {Expression{"0.01", {}}, Expression{"0.01", {}}, Expression{"J", {}}};
  tip.name.text = "tip";
  tip.mass.text = "M";
  model.system.bodies = {arm, tip};
  return model;
}

const VectorXd kPoint = (VectorXd(5) << 2.0, 0.2, 0.03, 0.4, 0.1).finished();
const VectorXd kWidths = (VectorXd(5) << 2.0, 0.2, 0.04, 0.4, 0.2).finished();

/// What a torque tells of a horizontal arm: J + m c^2 + 0.25 M by its acceleration, b by its speed, and m c
/// by gravity, which does not reach the tip here.
MatrixXd makeInformation() {
  MatrixXd slopes(3, 5);
  slopes << 0.04, 0.8, 1.0, 0.25, 0.0,  //
      0.0, 0.0, 0.0, 0.0, 1.0,          //
      0.2, 2.0, 0.0, 0.0, 0.0;
  const MatrixXd whitened = 1e3 * slopes * kWidths.asDiagonal();
  return whitened.transpose() * whitened;
}

TEST(BaseParameters, AreSumsOfTheNumbersOfBodiesThatResponsesAreLinearIn) {
  const BaseParameters base = findStandardSums(makeInformation(), kPoint, makeArm());
  ASSERT_EQ(base.sums.size(), 2U);  // b is a parameter
  EXPECT_EQ(base.undetermined, 2);
  EXPECT_EQ(base.parameters, (std::vector<Eigen::Index>{0, 1, 2, 3}));
  const std::vector<std::string> texts{base.describe(0), base.describe(1)};
  const bool first = texts[0] != "arm.mx";
  EXPECT_EQ(texts[first ? 1 : 0], "arm.mx");
  const std::string& inertia = texts[first ? 0 : 1];
  EXPECT_TRUE(inertia == "arm.Izz + 0.25 * tip.m" || inertia == "tip.m + 4 * arm.Izz") << inertia;
  const double scale = inertia.front() == 'a' ? 1.0 : 4.0;
  // elsewhere too, as the torque is linear in them
  const VectorXd other = (VectorXd(5) << 1.5, 0.15, 0.02, 0.3, 0.1).finished();
  EXPECT_NEAR(base.calc(other)[first ? 0 : 1], scale * (0.02 + 1.5 * 0.15 * 0.15 + 0.25 * 0.3), 1e-9);
  EXPECT_EQ(base.getUnit(first ? 1 : 0), "kg m");
  EXPECT_NE(base.makeExpression(first ? 1 : 0).find("(m)*(c)"), std::string::npos);
}

TEST(BaseParameters, AreNoneWhereEachParameterIsDetermined) {
  const MatrixXd information = 1e6 * MatrixXd::Identity(5, 5);
  EXPECT_TRUE(findStandardSums(information, kPoint, makeArm()).sums.empty());
}

}  // namespace
}  // namespace twinmap
