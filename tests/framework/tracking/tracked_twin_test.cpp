#include "framework/tracking/tracked_twin.hpp"

#include <gtest/gtest.h>

#include "framework/tracking/track_history.hpp"
#include "kernels/tracking/flat_state.hpp"
#include "tests/framework/tracking/records.hpp"

namespace twinmap {
namespace {

TrackedTwin track(const std::vector<TrackRecord>& records, int lag) {
  TrackedTwin twin(testing::makeModel(), lag);
  for (const TrackRecord& record : records) {
    twin.add(record);
  }
  return twin;
}

std::vector<double> flatten(const TrackPoint& point) {
  return tracking::flatten(point.tracker.getState());
}

TEST(TrackedTwin, HasTheSameBitsWhateverTheOrderOfMeasurements) {
  const std::vector<TrackRecord> records = testing::makeRecords(60);
  std::vector<TrackRecord> mixed = records;
  for (std::size_t i = 0; i + 4 < mixed.size(); i += 4) {
    std::swap(mixed[i], mixed[i + 3]);
  }
  const TrackedTwin in_order = track(records, 20), late = track(mixed, 20);
  EXPECT_EQ(flatten(in_order.getNow()), flatten(late.getNow()));
  EXPECT_EQ(flatten(in_order.getBase()), flatten(late.getBase()));
  EXPECT_EQ(in_order.getNow().alarm_count, late.getNow().alarm_count);
}

TEST(TrackedTwin, KnowsAMeasurementAgainAndRefusesOlderOnes) {
  const std::vector<TrackRecord> records = testing::makeRecords(60);
  const TrackedTwin twin = track(records, 20);
  EXPECT_NE(twin.findSame(records[50]), nullptr);
  EXPECT_FALSE(twin.isTooLate(records[50]));
  TrackRecord old = records[10];
  old.measurement.time += 1.0;
  EXPECT_TRUE(twin.isTooLate(old));
}

TEST(TrackedTwin, AnnouncesAStep) {
  const TrackedTwin twin = track(testing::makeRecords(60), 100);
  ASSERT_EQ(twin.getNow().alarms.size(), 1U);
  const TrackAlarm& alarm = twin.getNow().alarms.front();
  EXPECT_EQ(alarm.change.parameter, 0);
  EXPECT_EQ(alarm.change.time, 400.0);
  EXPECT_LE(alarm.announced, 420.0);
  EXPECT_NEAR(alarm.change.size, 0.2, 0.03);
  EXPECT_GT(alarm.change.probability, 0.95);
  EXPECT_TRUE(alarm.rivals.empty());
}

TEST(TrackHistory, SmoothsOnBothSidesOfAStep) {
  const auto [used, filtered, smoothed] =
      calcTrackCourse(testing::makeRecords(60), testing::makeModel()).whole;
  EXPECT_NEAR(smoothed.means(0, 38), 0.1, 4.0 * smoothed.stddevs(0, 38));
  EXPECT_NEAR(smoothed.means(0, 41), 0.3, 4.0 * smoothed.stddevs(0, 41));
  EXPECT_LT(smoothed.stddevs(0, 20), filtered.stddevs(0, 20));
  for (Eigen::Index j = 0; j < 2; ++j) {  // nothing comes after the last
    EXPECT_NEAR(smoothed.means(j, 59), filtered.means(j, 59), 0.5 * filtered.stddevs(j, 59));
  }
}

TEST(TrackRecord, IsReadBackWithTheSameBits) {
  const TrackRecord record = testing::makeRecords(8).back();
  const TrackRecord read = readRecord(writeRecord(record), 2, 1);
  EXPECT_EQ(read.measurement.values, record.measurement.values);
  EXPECT_EQ(read.measurement.rows, record.measurement.rows);
  EXPECT_TRUE(std::isnan(read.measurement.conditions[0]));
  EXPECT_TRUE(read.isSame(record));
  EXPECT_THROW(readRecord("{}", 2, 1), std::runtime_error);
  EXPECT_THROW(readRecord(writeRecord(record), 3, 1), std::runtime_error);
}

}  // namespace
}  // namespace twinmap
