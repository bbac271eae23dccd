#include "framework/data/sensitivity/fit_reduction.hpp"

#include <gtest/gtest.h>

#include "framework/base/random/random.hpp"
#include "framework/data/reduction/reduced_simulator.hpp"
#include "framework/experiment/files/experiment_file.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/models/mechanism/simulator/multibody_simulator.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr const char* kCart = TWINMAP_SOURCE_DIR "/experiments/duffing/cart.yaml";
constexpr const char* kLong =
    "features=[{samples: {outputs: [x], start: 0.005, interval: 0.005, count: 1000, reduce: automatic}}]";

class Reduction : public ::testing::Test {
 protected:
  ResponseReduction fit(int threads) const {
    RunControl control;
    control.threads = threads;
    return fitReduction(simulator_, experiment_, control);
  }

  ExperimentSpec experiment_ = loadExperiment(kCart, {kLong});
  MultibodySimulator simulator_{experiment_.model, collectTimes(experiment_.features)};
};

TEST_F(Reduction, KeepsWhatTellsAboutTheParameters) {
  const ResponseReduction reduction = fit(1);
  EXPECT_EQ(reduction.countSamples(), 1000);
  EXPECT_LE(reduction.countScores() * reduction.layout.times.size(), 200);
  EXPECT_GE(reduction.stddev_ratio.minCoeff(), 1.0 - 1e-12);
  EXPECT_LE(reduction.stddev_ratio.maxCoeff(), 1.003);
}

TEST_F(Reduction, IsTheSameForAnyNumberOfThreads) {
  EXPECT_EQ(fit(1).calcDigest(), fit(3).calcDigest());
}

TEST_F(Reduction, LeavesIndependentNoiseOfUnitVarianceAndBiasesNothing) {
  constexpr Index kDraws = 400;
  const ResponseReduction reduction = fit(1);
  const VectorXd clean = reduction.center;
  MatrixXd reduced(reduction.layout.getRowCount(), kDraws);
  const RandomStream random(1, RandomPurpose::kSingleNoise);
  for (Index i = 0; i < kDraws; ++i) {
    VectorXd noise(clean.size());
    random.drawNormals(static_cast<std::uint64_t>(i), 0, noise.data(),
                       static_cast<std::size_t>(noise.size()));
    reduced.col(i) = reduction.reduceMeasured(clean + noise.cwiseQuotient(reduction.inverse_stddev)) -
                     reduction.reduce(clean);
  }
  constexpr double kErrors = 4.5;  // standard errors, of some 60 numbers
  const double error = kErrors / std::sqrt(static_cast<double>(kDraws));
  EXPECT_LE(reduced.rowwise().mean().cwiseAbs().maxCoeff(), error);
  const MatrixXd covariance = reduced * reduced.transpose() / static_cast<double>(kDraws);
  const Index scores = reduction.countScores() * reduction.layout.times.size();
  EXPECT_LE(
      (covariance.topLeftCorner(scores, scores) - MatrixXd::Identity(scores, scores)).cwiseAbs().maxCoeff(),
      2.0 * error);
  // the sums' deviations count what is left of responses all over the bounds: none at the centre
  const VectorXd of_sums = covariance.diagonal().tail(covariance.rows() - scores);
  EXPECT_LE(of_sums.maxCoeff(), 1.0 + 2.0 * error);
  EXPECT_GE(of_sums.minCoeff(), 0.4);
  EXPECT_LE((covariance.bottomLeftCorner(of_sums.size(), scores)).cwiseAbs().maxCoeff(), 2.0 * error);
}

TEST_F(Reduction, HasTheDerivativesOfWhatItMakesOfResponses) {
  const auto reduction = std::make_shared<const ResponseReduction>(fit(1));
  ReducedSimulator simulator(simulator_.clone(), reduction);
  const VectorXd point = calcBoxCenter(experiment_.model.parameters) * 1.02;
  const VectorXd step = 1e-5 * point;
  MatrixXd points(point.size(), 2 * point.size()),
      responses(simulator.getLayout().getRowCount(), points.cols());
  for (Index p = 0; p < point.size(); ++p) {
    points.col(2 * p) = point + step[p] * VectorXd::Unit(point.size(), p);
    points.col(2 * p + 1) = point - step[p] * VectorXd::Unit(point.size(), p);
  }
  std::vector<SampleStatus> statuses(static_cast<std::size_t>(points.cols()));
  simulator.simulate(points, responses, statuses.data());
  MatrixXd response(responses.rows(), 1), derivatives;
  simulator.simulateWithDerivatives(point, response, derivatives, statuses.data());
  for (Index p = 0; p < point.size(); ++p) {
    const VectorXd difference = (responses.col(2 * p) - responses.col(2 * p + 1)) / (2.0 * step[p]);
    EXPECT_LE((derivatives.col(p) - difference).norm(), 1e-4 * difference.norm()) << p;
  }
}

TEST_F(Reduction, LooksLikeAnExperimentOfUnitNoise) {
  const ResponseReduction reduction = fit(1);
  const ExperimentSpec reduced = reduceExperiment(experiment_, reduction);
  EXPECT_EQ(collectTimes(reduced.features), reduction.layout.times);
  EXPECT_EQ(reduced.noise.stddev.size(), reduction.layout.output_names.size());
  EXPECT_FALSE(isReduced(reduced));
  EXPECT_TRUE(isReduced(experiment_));
}

TEST(ReducedSamples, AreRefusedWhereTheyCannotBe) {
  const auto explain = [](const std::vector<std::string>& overrides) {
    try {
      loadExperiment(kCart, overrides);
    } catch (const ExperimentError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(explain({kLong, "noise.stddev.x=0"}).find("noise.stddev of 'x' is 0"), std::string::npos);
  EXPECT_NE(explain({kLong, "noise.correlation={x: {autoregression: [0.5]}}"}).find("correlation"),
            std::string::npos);
  EXPECT_NE(
      explain(
          {"features=[{samples: {outputs: [x], start: 0.1, interval: 0.1, count: 20, reduce: automatic}}, "
           "{samples: {outputs: [x], start: 3, interval: 0.1, count: 10}}]"})
          .find("reduced in part"),
      std::string::npos);
}

/// With `count` samples of x and what else is given.
bool isReducedByDefault(int count, const std::vector<std::string>& more = {},
                        const std::string& samples = "") {
  std::vector<std::string> overrides{
      "features=[{samples: {outputs: [x], start: 0.0001, interval: 0.0001, count: " + std::to_string(count) +
      samples + "}}]"};
  overrides.insert(overrides.end(), more.begin(), more.end());
  return isReduced(reduceLongRecord(loadExperiment(kCart, overrides)));
}

TEST(LongRecord, IsReducedUnlessSomethingSpeaksAgainstIt) {
  EXPECT_FALSE(isReducedByDefault(9999));
  EXPECT_TRUE(isReducedByDefault(10000));
  EXPECT_FALSE(isReducedByDefault(10000, {}, ", reduce: none"));
  EXPECT_TRUE(isReducedByDefault(100, {}, ", reduce: automatic"));
  EXPECT_FALSE(isReducedByDefault(10000, {"noise.stddev.x=0", "transform=[z_score]"}));
  EXPECT_FALSE(isReducedByDefault(10000, {"noise.correlation={x: {autoregression: [0.5]}}"}));
  EXPECT_FALSE(isReducedByDefault(10000, {"inverse_map=none"}));
}

TEST(LongRecord, OfTwoOutputsCountsBoth) {
  const std::string outputs = "outputs={x: {coordinate: x}, v: {speed: x}}";
  const auto load = [&](int count) {
    return reduceLongRecord(loadExperiment(
        kCart, {outputs, "noise.stddev={x: 1e-4, v: 1e-3}",
                "features=[{samples: {outputs: [x, v], start: 0.0005, interval: 0.0005, count: " +
                    std::to_string(count) + "}}]"}));
  };
  EXPECT_FALSE(isReduced(load(4999)));
  EXPECT_TRUE(isReduced(load(5000)));
}

}  // namespace
}  // namespace twinmap
