#include "framework/experiment/noise_correlation.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "framework/experiment/files/experiment_file.hpp"
#include "tests/framework/experiment/experiments.hpp"

namespace twinmap {
namespace {

TEST(NoiseCorrelation, IsGivenByCoefficientsOrValues) {
  EXPECT_EQ(calcAutocorrelation(NoiseCorrelationSpec{{}, {0.5}, {}, {}}, 2), Eigen::Vector3d(1.0, 0.5, 0.25));
  EXPECT_EQ(calcAutocorrelation(NoiseCorrelationSpec{{}, {}, {1.0, 0.4}, {}}, 2),
            Eigen::Vector3d(1.0, 0.4, 0.0));
}

TEST(NoiseCorrelation, DefaultsFollowFromTheFeatureTimes) {
  const ExperimentSpec experiment = loadExperiment(kCart, {"noise.correlation={x: {autoregression: [0.5]}}"});
  EXPECT_EQ(experiment.noise.correlation[0].sample_time, 0.05);
  EXPECT_EQ(std::get<WhitenSpec>(experiment.transform[0].kind).by, WhitenBy::kCovariance);
  const std::string resolved = writeExperiment(experiment);
  EXPECT_EQ(writeExperiment(readExperiment(parseYaml(resolved, "resolved.yaml"))), resolved);
}

}  // namespace
}  // namespace twinmap
