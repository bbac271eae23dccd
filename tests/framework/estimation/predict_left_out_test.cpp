#include <gtest/gtest.h>

#include <cmath>

#include "framework/base/random/random.hpp"
#include "framework/estimation/estimate.hpp"
#include "framework/estimation/gp/train_gp_map.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {
namespace {

using Eigen::MatrixXd;

TEST(ResidualCorrelation, ByHand) {
  MatrixXd z(2, 2);
  z << 1, 0, 1, 1;
  const MatrixXd correlation = calcResidualCorrelation(z);
  EXPECT_DOUBLE_EQ(correlation(0, 0), 1.0);
  EXPECT_NEAR(correlation(0, 1), 1 / std::sqrt(2.0), 1e-15);
  EXPECT_EQ(correlation(0, 1), correlation(1, 0));
}

TEST(ResidualCorrelation, IsAlwaysPositiveDefinite) {
  MatrixXd twins(2, 3), one_sample(3, 1), silent(2, 2);
  twins << 1, 2, 3, -2, -4, -6;
  one_sample << 1, 2, -3;
  silent << 0, 0, 1, 2;
  for (const MatrixXd& z : {twins, one_sample, silent}) {
    const MatrixXd correlation = calcResidualCorrelation(z);
    EXPECT_TRUE((correlation.diagonal().array() == 1.0).all());
    EXPECT_GT(linalg::calcSymmetricEigenvalues(correlation)[0], 0.9e-6);
  }
  EXPECT_NEAR(calcResidualCorrelation(twins)(0, 1), -1.0, 2e-6);
  EXPECT_EQ(calcResidualCorrelation(silent)(0, 1), 0.0);
}

constexpr double kSumNoise = 0.04, kDifferenceNoise = 0.02;

/// p in [10, 20] and q in [-1, 1], seen through the sum and the difference of their places in these ranges,
/// each place in [-1, 1]. With the sum the noisier, the errors of both are correlated by
/// (0.04^2 - 0.02^2) / (0.04^2 + 0.02^2) = 0.6, their stddev in places sqrt(0.04^2 + 0.02^2) / 2.
LabelledFeatures makeSamples(int simulations, int replicates) {
  const RandomStream random(7, RandomPurpose::kTrainNoise);
  LabelledFeatures samples;
  samples.infos = {{"sum", "", 0, 0.0}, {"difference", "", 1, 0.0}};
  samples.replicates = replicates;
  samples.noise_covariance = MatrixXd::Identity(2, 2);
  samples.features.resize(2, simulations * replicates);
  samples.parameters.resize(2, simulations * replicates);
  for (int i = 0; i < simulations * replicates; ++i) {
    const int simulation = i % simulations;
    const double a = 2 * random.calcUniform(simulation, 0) - 1, b = 2 * random.calcUniform(simulation, 1) - 1;
    samples.parameters.col(i) << 15 + 5 * a, b;
    samples.features.col(i) << a + b + kSumNoise * random.calcNormal(i, 2),
        a - b + kDifferenceNoise * random.calcNormal(i, 3);
  }
  return samples;
}

class MapLeaveOneOut : public testing::TestWithParam<GpApproximation> {
 protected:
  static GpMapTraining trainOn(const LabelledFeatures& samples) {
    GpMapSpec spec;
    spec.approximation = GetParam();
    spec.inducing = 60;
    spec.refine_evaluations = 20;
    const TransformStepSpec z_score{ZScoreSpec{}, {}};
    return trainGpMap(spec, {z_score}, {"p", "q"}, samples, {1});
  }
};

// 120 simulations: a standard deviation is known to 6.5 % (replicates add a little), a correlation of 0.6 to
// 0.06.
TEST_P(MapLeaveOneOut, TellsErrorsAndTheirCorrelationFromTrainingAlone) {
  const double expected = std::hypot(kSumNoise, kDifferenceNoise) / 2;
  for (const int replicates : {1, 3}) {
    const LabelledFeatures samples = makeSamples(120, replicates);
    const GpMapTraining training = trainOn(samples);
    const MatrixXd error = training.leave_one_out.mean - samples.parameters;
    EXPECT_NEAR(std::sqrt(error.row(0).squaredNorm() / error.cols()) / (5 * expected), 1.0, 0.2)
        << replicates;
    EXPECT_NEAR(std::sqrt(error.row(1).squaredNorm() / error.cols()) / expected, 1.0, 0.2) << replicates;
    const MatrixXd z = error.cwiseQuotient(training.leave_one_out.stddev);
    EXPECT_NEAR(std::sqrt(z.row(0).squaredNorm() / z.cols()), 1.0, 0.2) << replicates;
    EXPECT_NEAR(training.map.residual_correlation(0, 1), 0.6, 0.2) << replicates;
  }
}

// The noise ends at its lower bound, far below what rounding leaves of the precision matrix.
TEST(MapLeaveOneOutOfSmoothFunctions, IsANumberWithoutAnyNoise) {
  const RandomStream random(7, RandomPurpose::kTrainNoise);
  LabelledFeatures samples = makeSamples(30, 1);
  for (int i = 0; i < 30; ++i) {
    const double a = 2 * random.calcUniform(i, 4) - 1, b = 2 * random.calcUniform(i, 5) - 1;
    samples.features.col(i) << a, b;
    samples.parameters.col(i) << std::sin(a) + 15, a * b;
  }
  const TransformStepSpec z_score{ZScoreSpec{}, {}};
  for (const GpCovariance covariance :
       {GpCovariance::kSquaredExponential, GpCovariance::kRationalQuadratic}) {
    GpMapSpec spec;
    spec.covariance = covariance;
    spec.mean = GpMean::kLinear;
    const GpMapTraining training = trainGpMap(spec, {z_score}, {"p", "q"}, samples, {1});
    EXPECT_TRUE(training.leave_one_out.stddev.allFinite());
    EXPECT_TRUE(training.map.residual_correlation.allFinite());
  }
}

INSTANTIATE_TEST_SUITE_P(Approximations, MapLeaveOneOut,
                         testing::Values(GpApproximation::kExact, GpApproximation::kSgpr));

}  // namespace
}  // namespace twinmap
