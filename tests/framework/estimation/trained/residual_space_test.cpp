#include "framework/estimation/trained/residual_space.hpp"

#include <gtest/gtest.h>

#include "kernels/linalg/decompositions.hpp"
#include "tests/framework/estimation/trained/oscillation.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using testing::Oscillation;

/// Two windows of 8 features, of which the surrogate's scores span one direction each; in the second another
/// direction moves by 5 noise standard deviations.
struct Example {
  static constexpr Index kFeatures = 16;

  std::vector<FeatureInfo> infos;
  MatrixXd clean = MatrixXd::Zero(kFeatures, 40);
  MatrixXd covariance;
  ForwardSurrogate surrogate;

  explicit Example(const MatrixXd& noise_covariance) : covariance(noise_covariance) {
    for (Index i = 0; i < kFeatures; ++i) {
      infos.push_back({"", "m", 0, 0.1 * static_cast<double>(i)});
    }
    const MatrixXd lower = linalg::calcCholesky(covariance).lower;
    MatrixXd whitened = MatrixXd::Zero(kFeatures, 40);
    for (Index j = 0; j < 40; ++j) {
      whitened(0, j) = 100.0 * ((j % 4) - 1.5);
      whitened(8, j) = 50.0 * ((j % 5) - 2.0);
      whitened(10, j) = 5.0 * ((j % 2) == 0 ? 1.0 : -1.0);
    }
    clean = lower * whitened;
    MatrixXd directions = MatrixXd::Zero(kFeatures, 2);
    directions(0, 0) = directions(8, 1) = 1.0;
    surrogate.center = VectorXd::Zero(kFeatures);
    surrogate.projection =
        directions.transpose() * linalg::solveLower(lower, MatrixXd::Identity(kFeatures, kFeatures));
  }
};

MatrixXd makeCorrelated() {
  MatrixXd covariance(Example::kFeatures, Example::kFeatures);
  for (Index i = 0; i < Example::kFeatures; ++i) {
    for (Index j = 0; j < Example::kFeatures; ++j) {
      covariance(i, j) = 0.04 * std::pow(0.6, std::abs(i - j));
    }
  }
  return covariance;
}

TEST(ResidualSpace, PutsInnovationsInThePlaceOfScoresAndDividesWhatIsUnmodelledByItsStandardDeviation) {
  for (const bool correlated : {false, true}) {
    const Example example(correlated
                              ? makeCorrelated()
                              : MatrixXd(0.04 * MatrixXd::Identity(Example::kFeatures, Example::kFeatures)));
    const ResidualSpace space =
        fitResidualSpace(example.infos, example.clean, example.covariance, example.surrogate);
    ASSERT_EQ(space.unmodelled.cols(), 1);
    EXPECT_NEAR(space.unmodelled_stddev(0), 5.0 * std::sqrt(40.0 / 39.0), 1e-9);
    VectorXd expected = VectorXd::LinSpaced(Example::kFeatures, -1.0, 1.0);
    VectorXd whitened = expected;
    whitened(0) = 77.0;
    whitened(8) = -33.0;
    whitened(10) = expected(10) * std::sqrt(1.0 + 25.0 * 40.0 / 39.0);
    const VectorXd innovation = (VectorXd(2) << expected(0), expected(8)).finished();
    VectorXd residual;
    space.calcResidual(linalg::calcCholesky(example.covariance).lower * whitened, innovation, residual);
    EXPECT_LT((residual - expected).cwiseAbs().maxCoeff(), 1e-10);
  }
}

TEST(ResidualSpace, SpansTheScoresOfASurrogate) {
  const TrustTraining training = Oscillation().makeTrustTraining();
  const ForwardSurrogate surrogate = Oscillation::fitSurrogate(training);
  const ResidualSpace space =
      fitResidualSpace(training.infos, training.clean_features, training.noise_covariance, surrogate);
  const MatrixXd gram = space.directions.transpose() * space.directions;
  EXPECT_LT((gram - MatrixXd::Identity(gram.rows(), gram.cols())).cwiseAbs().maxCoeff(), 1e-12);
  const MatrixXd projection = space.directions.transpose() / Oscillation::kNoise;
  EXPECT_LT((projection - surrogate.projection).cwiseAbs().maxCoeff(), 1e-9);
}

}  // namespace
}  // namespace twinmap
