#include "framework/data/features/feature_extractor.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace twinmap {
namespace {

FeatureSpec makeSamplesFeature(std::vector<Name> outputs, double start, double interval, int count) {
  return SamplesFeatureSpec{std::move(outputs), start, interval, count};
}

ResponseLayout makeLayoutInMetres(std::vector<std::string> outputs, const Eigen::VectorXd& times) {
  const std::vector<std::string> units(outputs.size(), "m");
  return {std::move(outputs), units, times};
}

TEST(FeatureExtractor, TimesAreSortedAndUnique) {
  const Eigen::VectorXd times = collectTimes(
      {makeSamplesFeature({{"a", {}}}, 0.5, 0.5, 3), makeSamplesFeature({{"b", {}}}, 0.0, 0.25, 3)});
  EXPECT_EQ(times, (Eigen::VectorXd(5) << 0.0, 0.25, 0.5, 1.0, 1.5).finished());
}

TEST(FeatureExtractor, TimesAreWhatPeopleWrite) {
  const Eigen::VectorXd times = collectTimes({makeSamplesFeature({{"a", {}}}, 0.1, 0.1, 30)});
  EXPECT_EQ(times[2], 0.3);
  EXPECT_EQ(times[29], 3.0);
}

TEST(FeatureExtractor, FindsTimesThatLieBetweenTwoPicoseconds) {
  // i * interval rounded before the sum, or after it alone, ends in other picoseconds for some of these
  const std::vector<FeatureSpec> features{
      makeSamplesFeature({{"a", {}}}, 0.0213079823, 0.00163907556138, 3000)};
  const Eigen::VectorXd times = collectTimes(features);
  const FeatureExtractor extractor(features, makeLayoutInMetres({"a"}, times));
  EXPECT_EQ(extractor.extract(times), times);
}

TEST(FeatureExtractor, PicksOutputsAtTheirTimes) {
  const std::vector<FeatureSpec> features{makeSamplesFeature({{"b", {}}}, 1.0, 1.0, 2),
                                          makeSamplesFeature({{"a", {}}, {"b", {}}}, 0.0, 2.0, 2)};
  const Eigen::VectorXd times = collectTimes(features);  // 0, 1, 2
  const FeatureExtractor extractor(features, makeLayoutInMetres({"a", "b"}, times));
  Eigen::MatrixXd responses(6, 2);
  responses << 1, 10, 2, 20, 3, 30, 4, 40, 5, 50, 6, 60;  // a at 0, 1, 2, then b
  Eigen::MatrixXd expected(6, 2);
  expected << 5, 50, 6, 60, 1, 10, 3, 30, 4, 40, 6, 60;
  EXPECT_EQ(extractor.extract(responses), expected);
  EXPECT_EQ(extractor.getInfos()[0].name, "b(1 s)");
  EXPECT_EQ(extractor.getInfos()[3].output, 0);
  EXPECT_EQ(extractor.getInfos()[3].unit, "m");
  EXPECT_DOUBLE_EQ(extractor.getInfos()[3].time, 2.0);
}

TEST(FeatureExtractor, AFailedSampleStaysInItsColumn) {
  const std::vector<FeatureSpec> features{makeSamplesFeature({{"a", {}}}, 0.0, 1.0, 2)};
  Eigen::MatrixXd responses(2, 3);
  responses << 1, std::nan(""), 3, 4, std::nan(""), 6;
  const Eigen::MatrixXd extracted =
      FeatureExtractor(features, makeLayoutInMetres({"a"}, collectTimes(features))).extract(responses);
  EXPECT_TRUE(extracted.col(1).array().isNaN().all());
  EXPECT_EQ(extracted.col(2), responses.col(2));
}

TEST(FeatureExtractor, PicksModes) {
  const FeatureSpec modes = ModesFeatureSpec{2, true, true}, frequencies = ModesFeatureSpec{3, true, false};
  EXPECT_EQ(countModes({modes, frequencies}), 3);
  const ResponseLayout layout{{"a"}, {"m"}, Eigen::VectorXd::Zero(1), 3};
  const FeatureExtractor extractor({modes, frequencies}, layout);
  Eigen::VectorXd response(7), expected(7);
  response << 99, 1, 2, 3, 0.1, 0.2, 0.3;  // a, three frequencies, three damping ratios
  expected << 1, 2, 0.1, 0.2, 1, 2, 3;
  EXPECT_EQ(extractor.extract(response), expected);
  EXPECT_EQ(extractor.getInfos()[1].name, "natural frequency 2");
  EXPECT_EQ(extractor.getInfos()[1].unit, "Hz");
  EXPECT_EQ(extractor.getInfos()[2].name, "damping ratio 1");
  EXPECT_THROW(FeatureExtractor({modes}, {{"a"}, {"m"}, Eigen::VectorXd::Zero(1), 1}), std::invalid_argument);
}

TEST(FeatureExtractor, RefusesWhatTheResponsesLack) {
  const std::vector<FeatureSpec> features{makeSamplesFeature({{"a", {}}}, 0.0, 1.0, 2)};
  EXPECT_THROW(FeatureExtractor(features, makeLayoutInMetres({"b"}, collectTimes(features))),
               std::invalid_argument);
  EXPECT_THROW(FeatureExtractor(features, makeLayoutInMetres({"a"}, Eigen::VectorXd::Zero(1))),
               std::invalid_argument);
}

}  // namespace
}  // namespace twinmap
