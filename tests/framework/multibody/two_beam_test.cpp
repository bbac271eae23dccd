#include "tests/framework/multibody/two_beam.hpp"

#include <gtest/gtest.h>

#include "framework/multibody/multibody_simulator.hpp"
#include "framework/simulation/sample_generator.hpp"

namespace twinmap::testing {
namespace {

constexpr int kPoints = 50;

/// Largest difference of each output to the closed form, over the output's range in that trajectory.
double calcLargestError(const ModelSpec& model, int points) {
  const Eigen::VectorXd times = makeTwoBeamTimes();
  const Eigen::MatrixXd parameters = makeTwoBeamPoints(points);
  const Trajectories result = generateSamples(MultibodySimulator(model, times), parameters);
  double largest = 0.0;
  for (int j = 0; j < points; ++j) {
    EXPECT_TRUE(result.statuses[j].ok) << result.statuses[j].reason;
    const Eigen::MatrixXd expected = integrateTwoBeam(parameters.col(j), times);
    for (int o = 0; o < 2; ++o) {
      const auto row = expected.row(o).transpose();
      const double range = row.maxCoeff() - row.minCoeff();
      const double error =
          (result.responses.col(j).segment(o * times.size(), times.size()) - row).cwiseAbs().maxCoeff();
      largest = std::max(largest, error / range);
    }
  }
  return largest;
}

TEST(TwoBeam, OracleIsFarMoreExactThanTheBar) {
  const Eigen::VectorXd times = makeTwoBeamTimes();
  const Eigen::Vector4d point = makeTwoBeamPoints(1).col(0);
  const Eigen::MatrixXd fine = integrateTwoBeam(point, times, 1e-5);
  const Eigen::MatrixXd coarse = integrateTwoBeam(point, times, 1e-4);
  EXPECT_LT((fine - coarse).cwiseAbs().maxCoeff(), 1e-8);
}

TEST(TwoBeam, DefaultToleranceFollowsTheClosedFormWithinTwoHundredThousandths) {
  const double error = calcLargestError(makeTwoBeam(), kPoints);
  RecordProperty("largest_error", std::to_string(error * 1e6) + "e-6");
  EXPECT_LT(error, 2e-5 / 2);  // with margin
}

}  // namespace
}  // namespace twinmap::testing
