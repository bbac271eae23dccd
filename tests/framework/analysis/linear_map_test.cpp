#include "framework/analysis/linear_map.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace twinmap::testing {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd makeLinearResponse() {
  MatrixXd matrix(4, 2);
  matrix << 1, 2, 3, -1, 0.5, 0.5, -2, 1;
  return matrix;
}

TEST(LinearMap, InvertsWhatIsLinear) {
  const MatrixXd points = MatrixXd::Random(2, 50);
  LabelledFeatures samples;
  samples.features = (makeLinearResponse() * points).array() + 3.0;
  samples.parameters = points;
  const LinearMap map = trainLinearMap({}, samples);
  const Estimates predictions = map.predict(samples.features, {});
  EXPECT_LT((predictions.mean - points).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_LT(predictions.stddev.maxCoeff(), 1e-12);
}

TEST(LinearMap, SeesKnownInputs) {
  LabelledFeatures samples;
  samples.parameters = MatrixXd::Random(1, 50);
  samples.inputs = MatrixXd::Random(1, 50);
  samples.features = 2.0 * samples.parameters + 5.0 * samples.inputs;
  const Estimates predictions = trainLinearMap({}, samples).predict(samples.features, samples.inputs);
  EXPECT_LT((predictions.mean - samples.parameters).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(LinearMap, ItsStddevIsThatOfWhatTheFeaturesDoNotExplain) {
  LabelledFeatures samples;
  samples.features = MatrixXd::Random(1, 4000);
  const MatrixXd rest = MatrixXd::Random(1, 4000);  // uniform on [-1, 1]
  samples.parameters = 3.0 * samples.features + rest;
  const LinearMap map = trainLinearMap({}, samples);
  EXPECT_NEAR(map.slopes(0, 0), 3.0, 0.05);
  EXPECT_NEAR(map.stddev[0], 1.0 / std::sqrt(3.0), 0.02);
}

}  // namespace
}  // namespace twinmap::testing
