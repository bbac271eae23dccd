#include "framework/tracking/track_power.hpp"

#include <gtest/gtest.h>

#include <sstream>

#include "tests/framework/support/linear_simulator.hpp"

namespace twinmap {
namespace {

TEST(TrackPower, OfLargerChangesIsSmaller) {
  const std::vector<AlarmDelay> delays = calcAlarmDelays(2, 1e-3, 1);
  ASSERT_EQ(delays.size(), 6U);
  EXPECT_LE(delays[0].median, 40.0);  // a step of 1, of 20 lives
  EXPECT_LE(delays[1].median, 6.0);
  EXPECT_LE(delays[3].median, 2.0);  // of 5
  EXPECT_GT(delays[0].median, delays[2].median);
  EXPECT_GT(delays[4].median, delays[5].median);  // slopes
  EXPECT_GE(delays[2].upper, delays[2].median);
  EXPECT_EQ(delays[3].found, 1.0);
}

TEST(TrackPower, FewerFalseAlarmsAreLater) {
  EXPECT_GT(calcAlarmDelays(1, 1e-5, 1)[1].median, calcAlarmDelays(1, 1e-2, 1)[1].median);
}

TEST(TrackPower, IsInUnitsOfAMeasurementGivenTheOtherParameters) {
  Estimates tests;
  tests.stddev = Eigen::MatrixXd::Constant(2, 5, 0.1);
  Eigen::Matrix2d correlation;
  correlation << 1.0, 0.8, 0.8, 1.0;
  tests.correlations = {correlation};
  std::istringstream lines(makeTrackPowerCsv(testing::makeParameters(2, -10.0, 10.0), tests, 1));
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line, "parameter,change,size,unit,size_in_sds,delay_median,delay_95,found");
  std::getline(lines, line);
  const std::size_t place = line.find("step,") + 5;
  EXPECT_NEAR(std::stod(line.substr(place)), 0.06, 1e-6);  // .1 sqrt(1 - .8^2)
}

}  // namespace
}  // namespace twinmap
