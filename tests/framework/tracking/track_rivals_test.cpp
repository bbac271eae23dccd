#include <gtest/gtest.h>

#include "tests/framework/tracking/records.hpp"

namespace twinmap {
namespace {

/// A parameter that follows how large the motion is, which decays; or that steps while it decays.
std::deque<CourseSample> makeCourse(bool follows) {
  std::mt19937 random(2);
  std::normal_distribution<double> normal;
  std::deque<CourseSample> course;
  for (int i = 0; i < 40; ++i) {
    const double amplitude = -0.1 * i;
    const double value = follows ? 0.05 * amplitude : (i < 20 ? 0.0 : -0.1);
    course.push_back({static_cast<double>(i),
                      Eigen::VectorXd::Constant(1, value + 0.01 * normal(random)),
                      Eigen::VectorXd::Constant(1, 1e-4),
                      {{"the amplitude of x", amplitude}}});
  }
  return course;
}

TEST(Rivals, AreWhatExplainsTheCourseAsWell) {
  EXPECT_EQ(findRivals(makeCourse(true), {0}, 20.0), std::vector<std::string>{"the amplitude of x"});
}

TEST(Rivals, AreNoneOfAStep) {
  EXPECT_TRUE(findRivals(makeCourse(false), {0}, 20.0).empty());
}

TEST(Rivals, OfSeveralParametersExplainAllOfThem) {
  std::deque<CourseSample> course;
  for (const bool second_follows : {true, false}) {
    const std::deque<CourseSample> one = makeCourse(true), other = makeCourse(second_follows);
    course.clear();
    for (std::size_t i = 0; i < one.size(); ++i) {
      course.push_back(one[i]);
      course.back().estimate = Eigen::Vector2d(one[i].estimate[0], 3.0 * other[i].estimate[0]);
      course.back().variances = Eigen::Vector2d(1e-4, 9e-4);
    }
    EXPECT_EQ(findRivals(course, {0, 1}, 20.0).size(), second_follows ? 1U : 0U);
  }
  for (CourseSample& sample : course) {  // the one that does not follow is not seen: nothing speaks against
    sample.variances[1] = std::numeric_limits<double>::infinity();
  }
  EXPECT_EQ(findRivals(course, {0, 1}, 20.0).size(), 1U);
}

TEST(Rivals, DoNotStandStill) {
  std::deque<CourseSample> course = makeCourse(true);
  for (CourseSample& sample : course) {
    sample.covariates[0].value = 0.1;
  }
  EXPECT_TRUE(findRivals(course, {0}, 20.0).empty());
}

TEST(Rivals, ThatRecurAreThoseOfWhateverChangesNext) {
  const std::vector<TrackAlarm> alarms{{1.0, false, {}, {"the speed of x"}},
                                       {5.0, false, {}, {"the amplitude of x", "the speed of x"}},
                                       {9.0, false, {}, {"the amplitude of x"}}};
  EXPECT_EQ(findRecurringRivals(alarms, 2.0), std::vector<std::string>{"the amplitude of x"});
  EXPECT_TRUE(findRecurringRivals(alarms, 6.0).empty());
}

}  // namespace
}  // namespace twinmap
