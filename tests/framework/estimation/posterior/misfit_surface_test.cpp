#include "framework/estimation/posterior/basins/misfit_surface.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/framework/estimation/posterior/surface.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kDecayTimes = 15;

VectorXd decay(const VectorXd& x) {
  return VectorXd::NullaryExpr(kDecayTimes, [&](Index i) {
    const double t = 0.2 * static_cast<double>(i);
    return x[0] * std::exp(-x[1] * t) + x[2] * t;
  });
}

std::vector<ParameterSpec> makeUnknown() {
  std::vector<ParameterSpec> unknown = testing::makeParameters(3, 0.5, 4.0);
  unknown[2].bounds.lower = -1.0;
  unknown[2].bounds.upper = 1.0;
  unknown[0].prior = PriorSpec{LognormalPrior{1.5, 1.3}};
  unknown[2].prior = PriorSpec{NormalPrior{0.1, 0.2}};
  return unknown;
}

/// A surface over the logarithms of the first two parameters has the linear model in the parameters
/// themselves that linearising there gives.
TEST(MisfitSurface, ConvertsToOtherCoordinatesWithoutSimulations) {
  const std::vector<ParameterSpec> unknown = makeUnknown();
  testing::Problem problem(kDecayTimes, decay, unknown, 0.01);
  const VectorXd truth = Eigen::Vector3d(1.3, 0.8, -0.1);
  const SearchBox box(unknown, {0, 3}, VectorXd::Zero(3));
  Misfit misfit(problem.simulator, problem.model, box, problem.measure(truth, 0.01));
  const Prior prior(unknown, {});
  const std::vector<Index> all = listIndices(Index{3});
  const LogCoordinates logs(unknown), plain(unknown, all);
  MisfitSurface in_logs({{&misfit, &problem.model, all}}, logs, prior);
  MisfitSurface as_they_are({{&misfit, &problem.model, all}}, plain, prior);
  const LocalSurface from = in_logs.linearize(logs.fromParameters(1.1 * truth)).front();
  const int simulations = in_logs.getSimulations();
  const LocalSurface converted = as_they_are.convert(from, in_logs);
  EXPECT_EQ(as_they_are.getSimulations(), simulations);
  const LocalSurface expected = as_they_are.linearize(plain.fromParameters(1.1 * truth)).front();
  EXPECT_TRUE(converted.at.isApprox(expected.at, 1e-12));
  EXPECT_TRUE(converted.information.isApprox(expected.information, 1e-9));
  EXPECT_TRUE(converted.descent.isApprox(expected.descent, 1e-9));
  EXPECT_NEAR(converted.misfit, expected.misfit, 1e-9 * expected.misfit);
  EXPECT_FALSE(from.information.isApprox(expected.information, 1e-2));
}

/// Parts that are simulated each by a thread say what they say one after the other.
TEST(MisfitSurface, TakesPartsSideBySide) {
  const std::vector<ParameterSpec> unknown = makeUnknown();
  testing::Problem first(kDecayTimes, decay, unknown, 0.01), second(kDecayTimes, decay, unknown, 0.02);
  const VectorXd truth = Eigen::Vector3d(1.3, 0.8, -0.1);
  const SearchBox box(unknown, {0, 3}, VectorXd::Zero(3));
  Misfit of_first(first.simulator, first.model, box, first.measure(truth, 0.01));
  Misfit of_second(second.simulator, second.model, box, second.measure(truth, 0.02, 2));
  const Prior prior(unknown, {});
  const LogCoordinates logs(unknown);
  const std::vector<Index> all = listIndices(Index{3});
  const std::vector<MeasuredPart> parts{{&of_first, &first.model, all}, {&of_second, &second.model, all}};
  MisfitSurface serial(parts, logs, prior), parallel(parts, logs, prior, true);
  const MatrixXd points = 0.3 * MatrixXd::Random(3, 5);
  EXPECT_EQ(serial.calcMisfits(points), parallel.calcMisfits(points));
  EXPECT_EQ(serial.linearize(points)[4].information, parallel.linearize(points)[4].information);
}

}  // namespace
}  // namespace twinmap
