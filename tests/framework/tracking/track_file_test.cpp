#include "framework/tracking/track_file.hpp"

#include <fmt/core.h>
#include <gtest/gtest.h>

#include "framework/base/files/atomic_file.hpp"
#include "framework/tracking/track_history.hpp"
#include "kernels/tracking/flat_state.hpp"
#include "tests/framework/test_folder.hpp"
#include "tests/framework/tracking/records.hpp"

namespace twinmap {
namespace {

const TrackIdentity kIdentity{"cart", "abc", "drift: {}\n"};

class TrackFile : public ::testing::Test {
 protected:
  void write(int count) {
    for (const TrackRecord& record : testing::makeRecords(count)) {
      twin_.add(record);
    }
    writeTrackFile(file_, kIdentity, twin_, 77);
  }
  std::optional<LoadedTrack> read(const TrackIdentity& identity) const {
    return readTrackFile(file_, identity, testing::makeModel(), 30);
  }

  const TestFolder folder_;
  const std::filesystem::path file_ = folder_ / "track.h5";
  TrackedTwin twin_{testing::makeModel(), 30};
};

TEST_F(TrackFile, GoesOnWithTheSameBits) {
  write(60);
  const std::optional<LoadedTrack> loaded = read(kIdentity);
  ASSERT_TRUE(loaded.has_value());
  EXPECT_EQ(loaded->history_bytes, 77U);
  EXPECT_EQ(tracking::flatten(loaded->twin.getNow().tracker.getState()),
            tracking::flatten(twin_.getNow().tracker.getState()));
  EXPECT_EQ(loaded->twin.getNow().alarm_count, twin_.getNow().alarm_count);
}

TEST_F(TrackFile, KeepsDiagnoses) {
  twin_.note({7.0, true, 0, 5.0, R"({"says": "nothing"})"});
  write(60);
  const std::optional<LoadedTrack> loaded = read(kIdentity);
  ASSERT_EQ(loaded->twin.getDiagnoses().size(), 1U);
  const AlarmDiagnosis& read = loaded->twin.getDiagnoses().front();
  EXPECT_EQ(read.announced, 7.0);
  EXPECT_TRUE(read.is_of_several);
  EXPECT_EQ(read.time, 5.0);
  EXPECT_EQ(read.answer, R"({"says": "nothing"})");
}

TEST_F(TrackFile, IsAsLargeAfterMoreMeasurements) {
  write(130);
  const auto size = std::filesystem::file_size(file_);
  for (TrackRecord record : testing::makeRecords(400)) {
    record.measurement.time += 1e5;
    twin_.add(record);
  }
  writeTrackFile(file_, kIdentity, twin_, 77);
  EXPECT_LT(std::filesystem::file_size(file_), size + size / 5);
}

TEST_F(TrackFile, OfAnotherRunOrSectionIsRefused) {
  write(3);
  EXPECT_THROW(read({"cart", "abd", kIdentity.tracking}), std::runtime_error);
  EXPECT_THROW(read({"cart", "abc", ""}), std::runtime_error);
}

TEST_F(TrackFile, ThatIsDamagedIsRefused) {
  write(3);
  std::string bytes = readBytes(file_);
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
  writeTextFile(file_, bytes);
  EXPECT_THROW(read(kIdentity), std::runtime_error);
}

TEST_F(TrackFile, IsNoneBeforeTheFirstMeasurement) {
  EXPECT_FALSE(read(kIdentity).has_value());
}

TEST_F(TrackFile, HistoryBehindTheStateIsCutOff) {
  const std::filesystem::path lines = folder_ / "track.jsonl";
  TrackHistory history(lines, 0);
  const std::vector<TrackRecord> records = testing::makeRecords(3);
  history.add(records[0]);
  const std::uint64_t answered = history.getBytes();
  history.add(records[1]);  // killed before the state was written
  EXPECT_EQ(TrackHistory(lines, answered).read(2, 1).size(), 1U);
  EXPECT_EQ(std::filesystem::file_size(lines), answered);
  EXPECT_THROW(TrackHistory(lines, answered + 1), std::runtime_error);
}

TEST_F(TrackFile, HistoryKnowsWhatWasCounted) {
  const std::filesystem::path lines = folder_ / "track.jsonl";
  const std::vector<TrackRecord> records = testing::makeRecords(30);
  std::vector<std::string> digests;
  std::uint64_t bytes = 0;
  for (int i = 0; i < 2; ++i) {  // the second goes on with the file of the first
    TrackHistory history(lines, bytes);
    for (int j = 0; j < 20; ++j) {
      const std::string digest = fmt::format("{:016x}{:016x}", 20 * i + j, 7);
      EXPECT_FALSE(history.contains(digest));
      TrackRecord record = records[static_cast<std::size_t>(j)];
      record.source = "of \"digest\":\"0\".csv";
      record.digest = digest;
      history.add(record);
      digests.push_back(digest);
      for (const std::string& known : digests) {
        EXPECT_TRUE(history.contains(known));
      }
    }
    bytes = history.getBytes();
  }
}

}  // namespace
}  // namespace twinmap
