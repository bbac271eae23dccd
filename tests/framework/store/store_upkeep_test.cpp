#include "framework/store/store_upkeep.hpp"

#include <gtest/gtest.h>

#include "framework/store/trajectory_store.hpp"
#include "tests/framework/test_folder.hpp"

namespace twinmap {
namespace {

namespace fs = std::filesystem;

constexpr const char* kContent = "model: 1\nsolver:\n  revision: 7\n  build: none\n";

TrajectoryStore openSmallStore(const fs::path& root) {
  return TrajectoryStore(root, kContent, 1, 2);
}

/// Samples at first, first + 1, ... whose responses are their points.
SampleBlock makeNumberedBlock(int first, int count) {
  SampleBlock block;
  block.parameters = Eigen::RowVectorXd::LinSpaced(count, first, first + count - 1);
  block.responses = block.parameters.replicate(2, 1);
  block.statuses.resize(static_cast<std::size_t>(count));
  return block;
}

fs::path findChunk(const TrajectoryStore& store) {
  for (const fs::directory_entry& entry : fs::directory_iterator(store.getFolder())) {
    if (entry.path().extension() == ".chunk") {
      return entry.path();
    }
  }
  return {};
}

/// Changes a byte of a response.
void damage(const fs::path& file) {
  std::string bytes = readFile(file);
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
  std::ofstream(file, std::ios::binary) << bytes;
}

TEST(StoreUpkeep, CountsSamplesOnceAndSaysWhatComputedThem) {
  const TestFolder root;
  TrajectoryStore store = openSmallStore(root.getPath());
  store.append(makeNumberedBlock(0, 4));
  store.append(makeNumberedBlock(3, 2));
  const std::vector<StoredModel> models = listStoredModels(root.getPath(), StoreReading::kIndex);
  ASSERT_EQ(models.size(), 1u);
  EXPECT_EQ(models[0].samples, 5);
  EXPECT_EQ(models[0].repeated, 1);
  EXPECT_EQ(models[0].chunks, 2);
  EXPECT_EQ(models[0].computed_with, "revision: 7; build: none");
  EXPECT_TRUE(models[0].problems.empty());
  EXPECT_THROW(listStoredModels(root / "none", StoreReading::kIndex), std::runtime_error);
}

TEST(StoreUpkeep, ReadingWholeFindsAChangedByte) {
  const TestFolder root;
  TrajectoryStore store = openSmallStore(root.getPath());
  store.append(makeNumberedBlock(0, 20));
  damage(findChunk(store));
  EXPECT_TRUE(listStoredModels(root.getPath(), StoreReading::kIndex)[0].problems.empty());
  const std::vector<StoredModel> models = listStoredModels(root.getPath(), StoreReading::kWhole);
  ASSERT_EQ(models[0].problems.size(), 1u);
  EXPECT_EQ(models[0].problems[0], findChunk(store).string() + ": its checksum is wrong");
}

TEST(StoreUpkeep, MergesWholeChunksAndLeavesDamagedOnes) {
  const TestFolder root;
  TrajectoryStore one = openSmallStore(root / "one"), other = openSmallStore(root / "other");
  one.append(makeNumberedBlock(0, 3));
  other.append(makeNumberedBlock(0, 3));
  other.append(makeNumberedBlock(3, 20));
  const MergeResult merged = mergeStores(root / "one", root / "other");
  EXPECT_EQ(merged.copied, 1);
  EXPECT_EQ(merged.present, 1);
  EXPECT_TRUE(merged.problems.empty());
  EXPECT_EQ(openSmallStore(root / "one").getSampleCount(), 23);

  damage(findChunk(other));
  const MergeResult fresh = mergeStores(root / "fresh", root / "other");
  EXPECT_EQ(fresh.copied, 1);
  EXPECT_EQ(fresh.problems.size(), 1u);
}

TEST(StoreUpkeep, PrunesWhatIsDamagedOrStoredElsewhereAndNoSample) {
  const TestFolder root;
  TrajectoryStore store = openSmallStore(root.getPath());
  store.append(makeNumberedBlock(0, 4));
  store.append(makeNumberedBlock(0, 4));  // the same bytes: the same file
  store.append(makeNumberedBlock(0, 6));
  std::ofstream(store.getFolder() / "a.chunk.set-aside") << "damaged";
  std::ofstream(store.getFolder() / "a.chunk.node7-1-2.tmp") << "perhaps under way";
  const int pruned = pruneStores(root.getPath()).files;
  EXPECT_GE(pruned, 1);
  EXPECT_EQ(openSmallStore(root.getPath()).getSampleCount(), 6);
  EXPECT_FALSE(fs::exists(store.getFolder() / "a.chunk.set-aside"));
  EXPECT_TRUE(fs::exists(store.getFolder() / "a.chunk.node7-1-2.tmp"));
}

}  // namespace
}  // namespace twinmap
