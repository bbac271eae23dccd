#include "framework/tracking/change_windows.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "framework/base/files/digest.hpp"
#include "framework/experiment/files/experiment_file.hpp"
#include "framework/tracking/recording_shelf.hpp"
#include "tests/framework/test_folder.hpp"
#include "tests/framework/tracking/records.hpp"

namespace twinmap {
namespace {

using Names = std::vector<std::string>;

Names listNames(const std::vector<const TrackRecord*>& records) {
  Names names;
  for (const TrackRecord* record : records) {
    names.push_back(record->source);
  }
  return names;
}

/// Of measurements of constants, which step at 400 s.
ChangeWindows choose(std::deque<TrackRecord> records, bool walks = false) {
  tracking::Model model = testing::makeModel();
  model.drifts = {{walks ? 0.95e-6 : 0.0}, {0.0}};  // over 10 s: a third of a measurement's sd
  TrackPoint now{tracking::Tracker(model)};
  for (const TrackRecord& record : records) {
    now.tracker.advance(record.measurement);
  }
  // the names outlive the records
  static std::deque<TrackRecord> kept;
  kept = std::move(records);
  return chooseChangeWindows(kept, now, 400.0);
}

std::deque<TrackRecord> make(int count) {
  const std::vector<TrackRecord> records = testing::makeRecords(count);
  return {records.begin(), records.end()};
}

TEST(ChangeWindows, AreSpreadOverBothSides) {
  const ChangeWindows windows = choose(make(50));
  EXPECT_EQ(listNames(windows.before), (Names{"m0", "m18", "m36", "m37", "m38", "m39"}));
  EXPECT_EQ(listNames(windows.after), (Names{"m40", "m41", "m42", "m43", "m46", "m49"}));
}

TEST(ChangeWindows, OfAWalkAreNear) {
  const ChangeWindows windows = choose(make(42), true);
  EXPECT_EQ(listNames(windows.before),
            (Names{"m30", "m33", "m36", "m37", "m38", "m39"}));  // ten steps of .31 sds are one
  EXPECT_EQ(listNames(windows.after), (Names{"m40", "m41"}));
}

TEST(ChangeWindows, LeaveOutWhatLiesApartOrSaysNothing) {
  std::deque<TrackRecord> records = make(50);
  records[0].estimate.setConstant(0.9);  // a bad measurement
  records[39].estimate.resize(0);        // one that does not update
  records[49].trial = "another";
  EXPECT_TRUE(choose(records).before.empty());  // of the trial of the last
  records[49].trial = "";
  EXPECT_EQ(listNames(choose(records).before), (Names{"m1", "m18", "m35", "m36", "m37", "m38"}));
}

/// A table of so many rows.
Table makeTable(Eigen::Index rows) {
  return {"m.csv",
          {{"t", "s", Eigen::VectorXd::LinSpaced(rows, 0.0, 20.0)}, {"x", "m", Eigen::VectorXd::Ones(rows)}},
          {}};
}

struct Shelved {
  const MeasurementReader reader{
      loadExperiment(std::string(TWINMAP_SOURCE_DIR) + "/bench/framework/tracking/ring.yaml")};
  RecordingShelf shelf;

  TrackRecord add(int number, Eigen::Index rows) {
    TrackRecord record{"m.csv", "digest" + std::to_string(number), "ok"};
    record.measurement.time = number;
    record.start = 8.0;
    shelf.add(reader, makeTable(rows), record);
    return record;
  }
  std::optional<KeptTable> find(const TrackRecord& record) const {
    return shelf.find(record, {"t", "x"}, MissingCells::kRefuse);
  }
};

TEST(RecordingShelf, KeepsTheWindowOfATable) {
  Shelved shelved;
  const std::optional<KeptTable> kept = shelved.find(shelved.add(1, 2001));
  ASSERT_TRUE(kept.has_value());
  EXPECT_EQ(kept->start, 8.0);
  const Eigen::VectorXd& times = kept->table.columns.front().values;
  EXPECT_NEAR(times[0], 8.0 - 0.75, 0.06);  // a quarter of 3 s beside it
  EXPECT_NEAR(times[times.size() - 1], 11.75, 0.06);
}

TEST(RecordingShelf, ForgetsTheOldest) {
  Shelved shelved;
  const TrackRecord first = shelved.add(0, 101);
  for (int i = 1; i < 48; ++i) {
    shelved.add(i, 101);
  }
  EXPECT_TRUE(shelved.find(first).has_value());
  shelved.add(48, 101);
  EXPECT_FALSE(shelved.find(first).has_value());
  const TrackRecord large = shelved.add(49, 10'000'000);  // 4.5 of 20 s: 4.5 million numbers
  EXPECT_FALSE(shelved.find(large).has_value());
}

TEST(RecordingShelf, ReadsAFileAgainThatIsTheSame) {
  const TestFolder folder;
  const std::filesystem::path file = folder / "m.csv";
  std::ofstream(file) << "t,x\n0,1\n1,2\n";
  TrackRecord record{file.string(), toHex(calcFileDigest(file)), "ok"};
  const Shelved shelved;
  EXPECT_FALSE(shelved.find(record).has_value());  // a name, not a path
  record.is_file = true;
  ASSERT_TRUE(shelved.find(record).has_value());
  EXPECT_EQ(shelved.find(record)->table.columns.size(), 2U);
  std::ofstream(file) << "t,x\n0,1\n1,3\n";
  EXPECT_FALSE(shelved.find(record).has_value());
}

}  // namespace
}  // namespace twinmap
