#include "framework/store/trajectory_store.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "framework/base/files/atomic_file.hpp"
#include "tests/framework/test_folder.hpp"

namespace twinmap {
namespace {

namespace fs = std::filesystem;
using Eigen::Index;
using Eigen::MatrixXd;

constexpr Index kParameters = 2, kRows = 5;

TrajectoryStore openStore(const fs::path& root, StoreAccess access = StoreAccess::kReadWrite) {
  return TrajectoryStore(root, "model", kParameters, kRows, access);
}

MatrixXd makePoints(int count, int first = 0) {
  return MatrixXd::NullaryExpr(kParameters, count, [&](Index p, Index i) {
    return 0.1 * static_cast<double>(p) + static_cast<double>(i + first);
  });
}

/// Row r of the sample at point p is r + p0.
SampleBlock makeBlockAt(const MatrixXd& points) {
  SampleBlock block;
  block.parameters = points;
  block.responses =
      Eigen::VectorXd::LinSpaced(kRows, 0, kRows - 1).rowwise().replicate(points.cols()).rowwise() +
      points.row(0);
  block.statuses.resize(points.cols());
  return block;
}

SampleBlock makeFailure(double p0, const std::string& reason, bool machine_dependent) {
  SampleBlock block = makeBlockAt(Eigen::Vector2d(p0, 0.0));
  block.responses.setConstant(std::numeric_limits<double>::quiet_NaN());
  block.statuses = {{false, reason, machine_dependent}};
  return block;
}

std::vector<fs::path> listChunks(const TrajectoryStore& store) {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(store.getFolder())) {
    if (entry.path().extension() == ".chunk") {
      files.push_back(entry.path());
    }
  }
  return files;
}

int countFiles(const fs::path& folder, const std::string& suffix) {
  int count = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    count += entry.path().extension() == suffix ? 1 : 0;
  }
  return count;
}

void overwrite(const fs::path& file, const std::string& bytes) {
  std::ofstream(file, std::ios::binary) << bytes;
}

TEST(TrajectoryStore, FindsWhatWasAppendedAlsoWhenOpenedAgain) {
  const TestFolder root;
  const MatrixXd points = makePoints(6);
  {
    TrajectoryStore store = openStore(root.getPath());
    EXPECT_EQ(store.findMissing(points).size(), 6u);
    store.append(makeBlockAt(points.leftCols(2)));
    store.append(makeBlockAt(points.middleCols(2, 3)));
    EXPECT_EQ(store.findMissing(points), std::vector<Index>{5});
    EXPECT_EQ(store.load(points.leftCols(5)).responses, makeBlockAt(points.leftCols(5)).responses);
  }
  const TrajectoryStore again = openStore(root.getPath());
  EXPECT_EQ(again.getSampleCount(), 5);
  EXPECT_TRUE(again.contains(points.col(4)));
  EXPECT_FALSE(again.contains(points.col(5)));
  const SampleBlock loaded = again.load(points.rowwise().reverse());
  EXPECT_EQ(loaded.statuses[0].reason, "not simulated");
  EXPECT_TRUE(loaded.responses.col(0).array().isNaN().all());
  EXPECT_EQ(loaded.responses.rightCols(5),
            MatrixXd(makeBlockAt(points.leftCols(5)).responses.rowwise().reverse()));
  EXPECT_EQ(readFile(again.getFolder() / "content.yaml"), "model");
}

TEST(TrajectoryStore, AnotherContentHasAFolderOfItsOwn) {
  const TestFolder root;
  TrajectoryStore store = openStore(root.getPath());
  store.append(makeBlockAt(makePoints(3)));
  const TrajectoryStore other(root.getPath(), "another model", kParameters, kRows);
  EXPECT_EQ(other.getSampleCount(), 0);
  EXPECT_NE(other.getFolder(), store.getFolder());
}

TEST(TrajectoryStore, PointsAreToldApartByTheirBits) {
  const TestFolder root;
  TrajectoryStore store = openStore(root.getPath());
  MatrixXd points(2, 4);
  points << 1.0, std::nextafter(1.0, 2.0), 1.0, 1.0, 0.0, 0.0, 0.0, -0.0;
  EXPECT_EQ(store.findMissing(points), (std::vector<Index>{0, 1, 3}));  // the third is the first again
  store.append(makeBlockAt(points.leftCols(1)));
  EXPECT_EQ(store.findMissing(points), (std::vector<Index>{1, 3}));
}

TEST(TrajectoryStore, AFailedSampleIsAResult) {
  const TestFolder root;
  openStore(root.getPath()).append(makeFailure(1.0, "step limit reached", false));
  const SampleBlock loaded = openStore(root.getPath()).load(Eigen::Vector2d(1.0, 0.0));
  EXPECT_FALSE(loaded.statuses[0].ok);
  EXPECT_EQ(loaded.statuses[0].reason, "step limit reached");
  EXPECT_TRUE(loaded.responses.array().isNaN().all());
}

TEST(TrajectoryStore, AFailureOfTheMachineIsTriedAgainNextTime) {
  const TestFolder root;
  const Eigen::Vector2d slow(1.0, 0.0);
  {
    TrajectoryStore store = openStore(root.getPath());
    store.append(makeFailure(1.0, "wall-time limit", true));
    EXPECT_TRUE(store.findMissing(slow).empty());  // one outcome for all that is done meanwhile
    EXPECT_EQ(store.load(slow).statuses[0].reason, "wall-time limit");
    EXPECT_TRUE(listChunks(store).empty());
  }
  EXPECT_EQ(openStore(root.getPath()).findMissing(slow).size(), 1u);
}

TEST(TrajectoryStore, DamagedChunksAreSetAsideAndTheirSamplesMissing) {
  std::mt19937 random(1);
  const std::string name_of_damage[] = {"flipped", "truncated", "emptied", "foreign"};
  for (const std::string& damage : name_of_damage) {
    const TestFolder root;
    const MatrixXd points = makePoints(4);
    fs::path damaged;
    {
      TrajectoryStore store = openStore(root.getPath());
      store.append(makeBlockAt(points.leftCols(3)));
      damaged = listChunks(store)[0];
      store.append(makeBlockAt(points.rightCols(1)));
    }
    std::string bytes = readFile(damaged);
    const std::size_t position = random() % bytes.size();
    if (damage == "flipped") {
      bytes[position] = static_cast<char>(bytes[position] ^ 4);
    } else if (damage == "foreign") {
      bytes = makeChunk(makeBlockAt(points.leftCols(3)), {Digest{}, kParameters, kRows});
    } else {
      bytes.resize(damage == "truncated" ? position : 0);
    }
    overwrite(damaged, bytes);
    TrajectoryStore reader = openStore(root.getPath(), StoreAccess::kReadOnly);
    reader.verify(points);
    EXPECT_EQ(reader.getSetAside().size(), 1u) << damage;
    EXPECT_TRUE(fs::exists(damaged));  // reading only changes nothing
    TrajectoryStore store = openStore(root.getPath());
    store.verify(points);
    EXPECT_EQ(store.findMissing(points), (std::vector<Index>{0, 1, 2})) << damage;
    ASSERT_EQ(store.getSetAside().size(), 1u);
    EXPECT_EQ(store.getSetAside()[0].file, damaged.string() + ".set-aside");
    EXPECT_EQ(readFile(store.getSetAside()[0].file), bytes);
    store.append(makeBlockAt(points.leftCols(3)));
    EXPECT_EQ(store.load(points).responses, makeBlockAt(points).responses);
  }
}

TEST(TrajectoryStore, AChunkDamagedWhileTheStoreIsOpenIsAnErrorNotAResult) {
  const TestFolder root;
  TrajectoryStore store = openStore(root.getPath());
  store.append(makeBlockAt(makePoints(3)));
  const fs::path chunk = listChunks(store)[0];
  std::string bytes = readFile(chunk);
  bytes[100] = static_cast<char>(bytes[100] ^ 1);
  overwrite(chunk, bytes);
  try {
    store.load(makePoints(3));
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(std::string(error.what()).rfind(chunk.string() + ": has been damaged since it was opened", 0),
              0u);
  }
}

TEST(TrajectoryStore, ALaterFormatIsAnErrorThatNamesTheFile) {
  const TestFolder root;
  fs::path chunk;
  {
    TrajectoryStore store = openStore(root.getPath());
    store.append(makeBlockAt(makePoints(3)));
    chunk = listChunks(store)[0];
  }
  std::string bytes = readFile(chunk);
  bytes.resize(bytes.size() - sizeof(Digest));
  bytes[8] = 7;
  const Digest digest = calcDigest(bytes.data(), bytes.size());
  overwrite(chunk, bytes.append(reinterpret_cast<const char*>(digest.data()), digest.size()));
  try {
    openStore(root.getPath());
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(std::string(error.what()).rfind(chunk.string() + ": is a chunk of format version 7", 0), 0u);
  }
  EXPECT_TRUE(fs::exists(chunk));
}

TEST(TrajectoryStore, RemovesWhatAnInterruptedWriteLeft) {
  const TestFolder root;
  const fs::path folder = openStore(root.getPath()).getFolder();
  const pid_t ended = ::fork();
  if (ended == 0) {
    overwrite(getTemporaryPath(folder / "abc.chunk"), "half a chunk");
    ::_exit(0);
  }
  ::waitpid(ended, nullptr, 0);
  const fs::path living = getTemporaryPath(folder / "abc.chunk"),
                 elsewhere = folder / "abc.chunk.node7-1-2.tmp";
  overwrite(living, "under way");
  overwrite(elsewhere, "perhaps under way");
  EXPECT_EQ(countFiles(folder, ".tmp"), 3);
  EXPECT_EQ(openStore(root.getPath(), StoreAccess::kReadOnly).getSampleCount(), 0);
  EXPECT_EQ(countFiles(folder, ".tmp"), 3);
  EXPECT_EQ(openStore(root.getPath()).getSampleCount(), 0);
  EXPECT_EQ(countFiles(folder, ".tmp"), 2);
  EXPECT_TRUE(fs::exists(living) && fs::exists(elsewhere));
}

// The temporary file is a link to /dev/full, where every write fails as on a full disk.
TEST(TrajectoryStore, AFullDiskIsAnErrorThatNamesTheFileAndKeepsWhatWasThere) {
  const TestFolder root;
  TrajectoryStore store = openStore(root.getPath());
  const MatrixXd points = makePoints(5);
  store.append(makeBlockAt(points.leftCols(2)));
  const SampleBlock block = makeBlockAt(points.rightCols(3));
  const std::string bytes = makeChunk(block, store.getShape());
  const fs::path file = store.getFolder() / (toHex(calcDigest(bytes.data(), bytes.size())) + ".chunk");
  fs::create_symlink("/dev/full", getTemporaryPath(file));
  try {
    store.append(block);
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(error.what(), getTemporaryPath(file).string() + ": cannot be written: No space left on device");
  }
  EXPECT_EQ(store.findMissing(points), (std::vector<Index>{2, 3, 4}));
  store.append(block);  // there is space again
  EXPECT_TRUE(store.findMissing(points).empty());
  EXPECT_EQ(store.load(points).responses, makeBlockAt(points).responses);
}

TEST(TrajectoryStore, FindsWhatAnotherWriterStoresMeanwhile) {
  const TestFolder root;
  TrajectoryStore one = openStore(root.getPath()), other = openStore(root.getPath());
  const MatrixXd points = makePoints(5);
  one.append(makeBlockAt(points.leftCols(3)));
  EXPECT_EQ(other.findMissing(points).size(), 5u);
  other.append(makeBlockAt(points.middleCols(2, 3)));  // the third is stored twice
  one.refresh();
  other.refresh();
  EXPECT_TRUE(one.findMissing(points).empty());
  EXPECT_EQ(one.load(points).responses, makeBlockAt(points).responses);
  EXPECT_EQ(other.load(points).responses, makeBlockAt(points).responses);
  EXPECT_EQ(openStore(root.getPath(), StoreAccess::kReadOnly).getSampleCount(), 5);
}

TEST(TrajectoryStore, ASampleOfADamagedChunkIsFoundWhereItIsStoredOnceMore) {
  const TestFolder root;
  const MatrixXd points = makePoints(3);
  fs::path damaged;
  {
    TrajectoryStore store = openStore(root.getPath());
    store.append(makeBlockAt(points));
    damaged = listChunks(store)[0];
    store.append(makeBlockAt(points.leftCols(2)));
  }
  std::string bytes = readFile(damaged);
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
  overwrite(damaged, bytes);
  TrajectoryStore store = openStore(root.getPath());
  store.verify(points);
  EXPECT_EQ(store.getSetAside().size(), 1u);
  EXPECT_EQ(store.findMissing(points), std::vector<Index>{2});
  EXPECT_EQ(store.load(points.leftCols(2)).responses, makeBlockAt(points.leftCols(2)).responses);
}

TEST(TrajectoryStore, AChunkThatVanishedIsMissingWhenItIsVerified) {
  const TestFolder root;
  TrajectoryStore one = openStore(root.getPath());
  one.append(makeBlockAt(makePoints(3)));
  TrajectoryStore other = openStore(root.getPath());
  fs::remove(listChunks(one)[0]);
  other.verify(makePoints(3));
  EXPECT_EQ(other.findMissing(makePoints(3)).size(), 3u);
  EXPECT_TRUE(other.getSetAside().empty());
}

TEST(TrajectoryStore, ReadingAFolderThatIsNotThereFindsNothingAndMakesNothing) {
  const TestFolder root;
  const TrajectoryStore store = openStore(root / "none", StoreAccess::kReadOnly);
  EXPECT_EQ(store.findMissing(makePoints(3)).size(), 3u);
  EXPECT_FALSE(fs::exists(root / "none"));
}

}  // namespace
}  // namespace twinmap
