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

tracking::Change makeChange() {
  tracking::Change change;
  change.time = 20.0;
  return change;
}

TEST(Rivals, AreWhatExplainsTheCourseAsWell) {
  EXPECT_EQ(findRivals(makeCourse(true), makeChange()), std::vector<std::string>{"the amplitude of x"});
}

TEST(Rivals, AreNoneOfAStep) {
  EXPECT_TRUE(findRivals(makeCourse(false), makeChange()).empty());
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
