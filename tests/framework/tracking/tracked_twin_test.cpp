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

/// Both parameters jump by 40 sds at the 40th, and with them what they follow.
std::vector<TrackRecord> makeJump(int count) {
  std::vector<TrackRecord> records = testing::makeRecords(count);
  for (std::size_t i = 0; i < records.size(); ++i) {
    records[i].covariates[0].value = i < 40 ? 0.0 : 5.0;
    records[i].estimate += i < 40 ? Eigen::Vector2d(0.0, 0.0) : Eigen::Vector2d(0.2, -0.4);
    records[i].measurement.values = records[i].estimate / 0.01;
  }
  return records;
}

TEST(TrackedTwin, NamesRivalsOfSeveralParametersAtOnce) {
  const TrackedTwin twin = track(makeJump(44), 100);
  ASSERT_EQ(twin.getNow().alarms.size(), 1U);
  const TrackAlarm& alarm = twin.getNow().alarms.front();
  EXPECT_TRUE(alarm.is_of_several);
  EXPECT_EQ(alarm.change.time, 400.0);  // of the first that did not fit
  EXPECT_EQ(alarm.rivals, std::vector<std::string>{"the amplitude of x"});
}

TEST(TrackedTwin, KeepsTheDiagnosisOfAnAlarmThatStays) {
  TrackedTwin twin = track(makeJump(44), 100);
  const TrackAlarm* alarm = twin.findUndiagnosed();
  ASSERT_NE(alarm, nullptr);
  twin.note({alarm->announced, true, alarm->change.parameter, alarm->change.time, "{}"});
  EXPECT_EQ(twin.findUndiagnosed(), nullptr);
  TrackRecord late = makeJump(44)[30];
  late.measurement.time += 1.0;
  twin.add(late);
  EXPECT_EQ(twin.findUndiagnosed(), nullptr);
  for (int i = 0; i < 100; ++i) {
    twin.note({static_cast<double>(i)});
  }
  EXPECT_EQ(twin.getDiagnoses().size(), kKeptAlarms);
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
  TrackRecord record = testing::makeRecords(8).back();
  record.trial = "free";
  record.start = 0.1;
  record.is_file = true;
  const TrackRecord read = readRecord(writeRecord(record), 2, 1);
  EXPECT_EQ(read.measurement.values, record.measurement.values);
  EXPECT_EQ(read.measurement.rows, record.measurement.rows);
  EXPECT_TRUE(std::isnan(read.measurement.conditions[0]));
  EXPECT_TRUE(read.isSame(record));
  EXPECT_EQ(read.trial, "free");
  EXPECT_EQ(read.start, 0.1);
  EXPECT_TRUE(read.is_file);
  EXPECT_THROW(readRecord("{}", 2, 1), std::runtime_error);
  EXPECT_THROW(readRecord(writeRecord(record), 3, 1), std::runtime_error);
}

}  // namespace
}  // namespace twinmap
