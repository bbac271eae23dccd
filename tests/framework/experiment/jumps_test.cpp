#include "framework/experiment/model/jumps.hpp"

#include <gtest/gtest.h>

#include "framework/experiment/model/elements/force_elements.hpp"

namespace twinmap {
namespace {

std::string describe(const char* force) {
  return describeJump(Expression{force, {}});
}

TEST(Jumps, AreNamedWithTheirSmoothForm) {
  EXPECT_EQ(describe("F - mu * sign(x_dot)"),
            "sign(x_dot) jumps: write tanh(x_dot / eps), eps a small value of x_dot");
  EXPECT_EQ(
      describe("-c * v * abs (v - (1 + 2) * w)"),
      "abs(v - (1 + 2) * w) has a kink: write sqrt((v - (1 + 2) * w)^2 + eps^2), eps a small value of v - "
      "(1 + 2) * w");
  EXPECT_EQ(describe("floor(x / pitch)"), "floor(x / pitch) jumps: write the force without it");
}

TEST(Jumps, WithTheOwnSpeedAreDryFriction) {
  ForceLaw<Expression> law;
  law.coordinate.text = "x";
  law.force = Expression{"F - mu * sign(x_dot)", {}};
  EXPECT_EQ(
      describeJump(law),
      "sign(x_dot) jumps: give this term as friction: [{coordinate: x, model: coulomb, coulomb: LEVEL}]");
  law.coordinate.text = "y";  // of another coordinate it is none
  EXPECT_EQ(describeJump(law), describe("F - mu * sign(x_dot)"));
}

TEST(Jumps, AreNotSeenInNamesOrSmoothForces) {
  EXPECT_EQ(describe("F - mu * tanh(x_dot / v0)"), "");
  EXPECT_EQ(describe("design(3) + signal * x + absolute"), "");
  EXPECT_EQ(describe("sign(x"), "");
  EXPECT_EQ(describe("-c * x_dot * abs(x_dot)"), "");
  EXPECT_EQ(describe("-c * abs(x_dot)*x_dot"), "");
}

}  // namespace
}  // namespace twinmap
