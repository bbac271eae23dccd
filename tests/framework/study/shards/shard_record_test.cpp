#include "framework/study/shards/shard_record.hpp"

#include "tests/framework/test_folder.hpp"

namespace twinmap {
namespace {

TEST(ShardRecord, OfNoFileIsOneThatNobodyHasBegun) {
  const TestFolder folder;
  const ShardRecord record(folder.getPath(), 3);
  EXPECT_EQ(record.getState(), ShardState::kMissing);
  EXPECT_EQ(record.describeLast(), "");
  EXPECT_EQ(record.getRefusal(), "");
}

TEST(ShardRecord, IsReadAsItWasWritten) {
  const TestFolder folder;
  ShardRecord written(folder.getPath(), 3);
  written.begin();
  EXPECT_EQ(ShardRecord(folder.getPath(), 3).getState(), ShardState::kRunning);
  written.end(ShardState::kFailed, "no \"space\"", {{"case_2", "singular", "twinmap run e.yaml k=2"}});
  const ShardRecord read(folder.getPath(), 3);
  EXPECT_EQ(read.getState(), ShardState::kFailed);
  ASSERT_EQ(read.getAttempts().size(), 1U);
  EXPECT_EQ(read.getAttempts()[0].reason, "no \"space\"");
  ASSERT_EQ(read.getAttempts()[0].failures.size(), 1U);
  EXPECT_EQ(read.getAttempts()[0].failures[0].name, "case_2");
  EXPECT_EQ(read.getAttempts()[0].failures[0].reason, "singular");
  EXPECT_EQ(read.getAttempts()[0].failures[0].command, "twinmap run e.yaml k=2");
  EXPECT_EQ(read.describeLast(), "try 1 on " + read.getAttempts()[0].host + ": failed: no \"space\"");
  EXPECT_EQ(ShardRecord(folder.getPath(), 4).getState(), ShardState::kMissing);
}

TEST(ShardRecord, IsRefusedAfterTheSameFailureTwice) {
  const TestFolder folder;
  ShardRecord record(folder.getPath(), 0);
  const auto fail = [&](const std::string& reason) {
    record.begin();
    record.end(ShardState::kFailed, reason);
  };
  fail("no space");
  EXPECT_EQ(record.getRefusal(), "");
  fail("singular");
  EXPECT_EQ(record.getRefusal(), "");
  fail("singular");
  EXPECT_EQ(record.getRefusal(), "singular");
  record.begin();
  record.end(ShardState::kDone);
  EXPECT_EQ(record.getRefusal(), "");
}

TEST(ShardRecord, OfAnAttemptWithoutAnEndIsLost) {
  const TestFolder folder;
  ShardRecord record(folder.getPath(), 0);
  record.begin();
  EXPECT_EQ(record.getRefusal(), "");
  record.begin();  // nobody ended the first
  EXPECT_NE(record.getRefusal().find("without a word"), std::string::npos);
  record.end(ShardState::kInterrupted, "stopped after 7 of 9");
  EXPECT_EQ(record.getRefusal(), "");
  record.begin();
  record.end(ShardState::kInterrupted, "stopped after 8 of 9");  // it went on
  EXPECT_EQ(record.getRefusal(), "");
  record.begin();
  record.end(ShardState::kInterrupted, "stopped after 8 of 9");
  EXPECT_EQ(record.getRefusal(), "stopped after 8 of 9");
}

}  // namespace
}  // namespace twinmap
