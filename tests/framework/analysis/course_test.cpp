#include "framework/analysis/course.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "framework/base/random/random.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr Index kMeasurements = 30;
constexpr double kLevel = 0.01;

VectorXd drawErrors(std::uint64_t set) {
  VectorXd errors(kMeasurements);
  RandomStream(7, RandomPurpose::kTestNoise).drawNormals(set, 0, errors.data(), kMeasurements);
  return errors;
}

VectorXd number() {
  return VectorXd::LinSpaced(kMeasurements, 1.0, kMeasurements);
}

TEST(Course, OfAStepIsTheDifferenceOfTheWeightedMeans) {
  VectorXd stddevs = VectorXd::Constant(kMeasurements, 0.1);
  stddevs.tail(10).setConstant(0.2);
  VectorXd values = 5.0 + stddevs.cwiseProduct(drawErrors(0)).array();
  values.tail(18).array() -= 1.0;
  const Course course = fitCourse(values, stddevs, number(), kLevel);
  ASSERT_EQ(course.shape, CourseShape::kStep);
  EXPECT_EQ(course.begins, 12);
  const VectorXd weights = stddevs.cwiseAbs2().cwiseInverse();
  const double before = weights.head(12).dot(values.head(12)) / weights.head(12).sum();
  const double after = weights.tail(18).dot(values.tail(18)) / weights.tail(18).sum();
  EXPECT_NEAR(course.change, after - before, 1e-12);
  EXPECT_NEAR(course.change_stddev, std::sqrt(1.0 / weights.head(12).sum() + 1.0 / weights.tail(18).sum()),
              1e-12);
  EXPECT_NEAR(course.fitted[11], before, 1e-12);
  EXPECT_NEAR(course.fitted[12], after, 1e-12);
  EXPECT_DOUBLE_EQ(course.p_value, 1.0 / 2000.0);
}

TEST(Course, OfALongHistoryIsFoundToTheMeasurement) {
  for (const Index count : {99, 200, 317}) {
    for (const Index begins : {Index{1}, count / 3, 2 * count / 3, count - 2}) {
      VectorXd values = VectorXd::Constant(count, 5.0);
      values.tail(count - begins).array() += 1.0;
      const Course course = fitCourse(values, VectorXd::Constant(count, 0.05),
                                      VectorXd::LinSpaced(count, 1.0, static_cast<double>(count)), kLevel);
      EXPECT_EQ(course.shape, CourseShape::kStep);
      EXPECT_EQ(course.begins, begins) << count;
    }
  }
}

TEST(Course, OfARampBeginsWhereItBends) {
  VectorXd values = VectorXd::Constant(kMeasurements, 2.0) + 0.01 * drawErrors(1);
  for (Index i = 10; i < kMeasurements; ++i) {
    values[i] += 0.05 * static_cast<double>(i - 10);
  }
  const Course course = fitCourse(values, VectorXd::Constant(kMeasurements, 0.01), number(), kLevel);
  ASSERT_EQ(course.shape, CourseShape::kRamp);
  EXPECT_NEAR(static_cast<double>(course.begins), 10.0, 1.0);
  EXPECT_NEAR(course.change, 0.05 * 19.0, 0.06);
  EXPECT_NEAR(course.scatter, 1.0, 0.4);
}

TEST(Course, WithoutAChangeIsTheWeightedMean) {
  const VectorXd stddevs = VectorXd::LinSpaced(kMeasurements, 0.1, 0.3);
  const VectorXd values = 5.0 + stddevs.cwiseProduct(drawErrors(2)).array();
  const VectorXd weights = stddevs.cwiseAbs2().cwiseInverse();
  const Course course = fitCourse(values, stddevs, number(), kLevel);
  EXPECT_EQ(course.shape, CourseShape::kConstant);
  EXPECT_TRUE(course.fitted.isApproxToConstant(weights.dot(values) / weights.sum(), 1e-12));
  EXPECT_EQ(course.change, 0.0);
}

/// The share of sets without a change in which one is seen, at a level of 5 %.
double countAlarms(double scatter) {
  constexpr int kSets = 300;
  int alarms = 0;
  for (int set = 0; set < kSets; ++set) {
    const VectorXd values = scatter * drawErrors(static_cast<std::uint64_t>(100 + set));
    alarms +=
        fitCourse(values, VectorXd::Ones(kMeasurements), number(), 0.05).shape != CourseShape::kConstant;
  }
  return static_cast<double>(alarms) / kSets;
}

TEST(Course, SeesNoMoreChangesThanItsLevelStates) {
  EXPECT_NEAR(countAlarms(1.0), 0.05, 0.04);  // three standard errors
  EXPECT_NEAR(countAlarms(3.0), 0.05, 0.04);  // repeats that scatter by more than stated
}

TEST(Course, NeedsSixValuesWithStandardDeviations) {
  EXPECT_THROW(fitCourse(VectorXd::Ones(5), VectorXd::Ones(5), VectorXd::LinSpaced(5, 0, 4), kLevel),
               std::invalid_argument);
  EXPECT_THROW(fitCourse(VectorXd::Ones(6), VectorXd::Zero(6), VectorXd::LinSpaced(6, 0, 5), kLevel),
               std::invalid_argument);
}

}  // namespace
}  // namespace twinmap
