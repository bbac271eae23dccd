#include <gtest/gtest.h>

#include <cmath>

#include "framework/study/pipeline/preparation/prepare_data.hpp"

namespace twinmap {
namespace {

/// Output y at t = 0 .. 8, one maximum of at least 1 wanted, noise 0.3.
ExperimentSpec makeExperiment() {
  ExperimentSpec experiment;
  experiment.model.parameters.resize(1);
  experiment.features.resize(1);
  experiment.features[0] = ExtremaFeatureSpec{{"y", {}}, {0.0, 1.0, 9}, ExtremaKind::kMaxima, 1, 1.0, 3};
  experiment.noise.stddev = {{{"y", {}}, 0.3}};
  experiment.noise.replicates = 20;
  return experiment;
}

/// A bell of a height at t = 4 in each column.
Trajectories makeBells(const std::vector<double>& heights) {
  Trajectories set;
  const auto count = static_cast<Eigen::Index>(heights.size());
  set.layout = {{"y"}, {"m"}, Eigen::VectorXd::LinSpaced(9, 0.0, 8.0)};
  set.responses.resize(9, count);
  set.parameters.resize(1, count);
  set.statuses.resize(heights.size());
  for (Eigen::Index i = 0; i < count; ++i) {
    set.parameters(0, i) = heights[i];
    for (Eigen::Index k = 0; k < 9; ++k) {
      set.responses(k, i) = heights[i] * std::exp(-0.5 * static_cast<double>((k - 4) * (k - 4)));
    }
  }
  return set;
}

TEST(LabelledSets, SamplesThatLackAFeatureFailWithTheReasonAndKeepTheirPlace) {
  const ExperimentSpec experiment = makeExperiment();
  // no peak, one that only the noise can hide, and two that stand out
  SimulatedSets sets{makeBells({0.5, 1.3, 20.0, 30.0}), makeBells({20.0, 0.5, 30.0})};
  sets.train.statuses[3] = {false, "step limit"};
  sets.train.responses.col(3).setConstant(std::nan(""));
  const FeatureExtractor extractor(experiment.features, sets.train.layout);
  sets = failIncompleteSamples(experiment, extractor, std::move(sets));

  EXPECT_EQ(sets.train.statuses[0].reason, "feature 'y maximum 1 value' is missing in the response");
  EXPECT_EQ(sets.train.statuses[1].reason.rfind("feature 'y maximum 1 value' is missing in the response with "
                                                "noise (draw ",
                                                0),
            0U);
  EXPECT_EQ(sets.train.statuses[3].reason, "step limit");
  EXPECT_EQ(findSuccessful(sets.train), (std::vector<int>{2}));
  EXPECT_EQ(findSuccessful(sets.test), (std::vector<int>{0, 2}));

  const FeatureNoise noise(extractor, Eigen::VectorXd::Constant(9, 0.3), 1);
  const LabelledSets labelled = makeLabelledSets(experiment, sets, extractor, noise);
  EXPECT_TRUE(labelled.train.features.allFinite());
  EXPECT_TRUE(labelled.train.noise_covariance.toMatrix().allFinite());
  EXPECT_EQ(labelled.train.features.cols(), 20);
  EXPECT_EQ(labelled.train.parameters, Eigen::MatrixXd::Constant(1, 20, 20.0));
  EXPECT_EQ(labelled.test.parameters, Eigen::RowVector2d(20.0, 30.0));
  EXPECT_TRUE(labelled.test.features.allFinite());
  EXPECT_NEAR(labelled.test.features(0, 1), 30.0, 2.0);
}

TEST(LabelledSets, SplitPointsByTheRoleOfTheirParameters) {
  ExperimentSpec experiment = makeExperiment();
  experiment.model.nuisance.resize(2);
  experiment.model.inputs.resize(1);
  SimulatedSets sets{makeBells({20.0, 25.0}), makeBells({20.0, 25.0})};
  Eigen::MatrixXd points(4, 2);
  points << 1, 5, 2, 6, 3, 7, 4, 8;
  sets.train.parameters = sets.test.parameters = points;
  const FeatureExtractor extractor(experiment.features, sets.train.layout);
  const FeatureNoise noise(extractor, Eigen::VectorXd::Constant(9, 0.3), 1);
  const LabelledFeatures test = makeLabelledSets(experiment, sets, extractor, noise).test;
  EXPECT_EQ(test.parameters, points.topRows(1));
  EXPECT_EQ(test.nuisance, points.middleRows(1, 2));
  EXPECT_EQ(test.inputs, points.bottomRows(1));
  EXPECT_EQ(test.collectUnknown(), points.topRows(3));
  EXPECT_EQ(test.collectPoints(), points);
}

TEST(LabelledSets, TheNoiseOfASampleDoesNotDependOnFailuresOfOthers) {
  const ExperimentSpec experiment = makeExperiment();
  SimulatedSets whole{makeBells({20.0, 25.0, 30.0}), makeBells({20.0, 25.0, 30.0})};
  SimulatedSets lacking{makeBells({20.0, 0.5, 30.0}), makeBells({20.0, 0.5, 30.0})};
  const FeatureExtractor extractor(experiment.features, whole.train.layout);
  whole = failIncompleteSamples(experiment, extractor, std::move(whole));
  lacking = failIncompleteSamples(experiment, extractor, std::move(lacking));
  const FeatureNoise noise(extractor, Eigen::VectorXd::Constant(9, 0.3), 1);
  const Eigen::MatrixXd expected = makeLabelledSets(experiment, whole, extractor, noise).test.features;
  const Eigen::MatrixXd found = makeLabelledSets(experiment, lacking, extractor, noise).test.features;
  ASSERT_EQ(found.cols(), 2);
  EXPECT_EQ(found.col(0), expected.col(0));
  EXPECT_EQ(found.col(1), expected.col(2));
}

}  // namespace
}  // namespace twinmap
