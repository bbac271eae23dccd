// A linear model whose input noise is drawn: its size is known.
#include "framework/inference/measurement/excitation_noise.hpp"

#include <gtest/gtest.h>

#include <random>

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index kRows = 300;

VectorXd draw(Index count, unsigned seed) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal;
  return VectorXd::NullaryExpr(count, [&](Index) { return normal(generator); });
}

/// What an impulse at each time does to an oscillator later.
MatrixXd makeImpulses() {
  return MatrixXd::NullaryExpr(kRows, kRows, [](Index i, Index j) {
    const auto lag = static_cast<double>(i - j);
    return i <= j ? 0.0 : std::exp(-0.02 * lag) * std::sin(0.2 * lag);
  });
}

MatrixXd makeWaves() {
  MatrixXd jacobian(kRows, 2);
  jacobian.col(0) = VectorXd::LinSpaced(kRows, 0.0, 6.0).array().sin();
  jacobian.col(1) = VectorXd::LinSpaced(kRows, 0.0, 9.0).array().cos();
  return 50.0 * jacobian;
}

TEST(ExcitationNoise, IsFoundInItsSize) {
  const MatrixXd responses = makeImpulses(), jacobian = makeWaves();
  const VectorXd residual =
      draw(kRows, 1) + 0.3 * responses * draw(kRows, 2) + jacobian * VectorXd::Constant(2, 0.4);
  const std::optional<InputNoise> found = findInputNoise(residual, jacobian, responses, 30.0);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->size, 0.3, 0.1);
  EXPECT_GT(found->gain, 20.0);
  EXPECT_NEAR(found->chi_square, kRows - 2.0, 4.0 * std::sqrt(2.0 * kRows));
}

TEST(ExcitationNoise, IsNotFoundWhereThereIsNone) {
  int named = 0;
  for (unsigned seed = 10; seed < 30; ++seed) {
    named += findInputNoise(draw(kRows, seed), makeWaves(), makeImpulses(), 30.0)->gain > 10.8 ? 1 : 0;
  }
  EXPECT_EQ(named, 0);
  EXPECT_FALSE(findInputNoise(draw(kRows, 1), makeWaves(), MatrixXd::Zero(kRows, 3), 30.0));
}

}  // namespace
}  // namespace twinmap
