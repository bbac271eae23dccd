#include "framework/base/files/settled_files.hpp"

#include <gtest/gtest.h>

#include "framework/base/files/atomic_file.hpp"
#include "framework/base/files/temporary_folder.hpp"

namespace twinmap {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;

class SettledFilesTest : public ::testing::Test {
 protected:
  void write(const std::string& name, const std::string& text) {
    writeTextFile(folder_.getPath() / name, text);
  }

  /// Names of what is complete so many milliseconds after the first look.
  std::vector<std::string> take(int after) {
    std::vector<std::string> names;
    for (const fs::path& file : files_.take(SettledFiles::Clock::time_point() + milliseconds(after))) {
      names.push_back(file.filename().string());
    }
    return names;
  }

  using Names = std::vector<std::string>;
  TemporaryFolder folder_;
  SettledFiles files_{folder_.getPath(), {".csv"}};
};

TEST_F(SettledFilesTest, AreTakenOnceWhereTheyNoLongerChange) {
  write("b.csv", "1");
  write("a.CSV", "1");
  write("a.h5", "1");
  write(".c.csv", "1");
  EXPECT_EQ(take(0), Names{});
  EXPECT_TRUE(files_.areSettling());
  EXPECT_EQ(take(1000), (Names{"a.CSV", "b.csv"}));
  EXPECT_FALSE(files_.areSettling());
  EXPECT_EQ(take(2000), Names{});
}

TEST_F(SettledFilesTest, AreNotCompleteWhileTheyGrow) {
  write("a.csv", "1");
  EXPECT_EQ(take(0), Names{});
  write("a.csv", "1,2");
  EXPECT_EQ(take(1000), Names{});
  EXPECT_EQ(take(1900), Names{});
  EXPECT_EQ(take(2000), Names{"a.csv"});
}

TEST_F(SettledFilesTest, AreTakenAgainWhereTheyChangedOrCameBack) {
  write("a.csv", "1");
  take(0);
  EXPECT_EQ(take(1000), Names{"a.csv"});
  write("a.csv", "1,2");
  EXPECT_EQ(take(2000), Names{});
  EXPECT_EQ(take(3000), Names{"a.csv"});
  fs::remove(folder_.getPath() / "a.csv");
  EXPECT_EQ(take(4000), Names{});
  EXPECT_FALSE(files_.areSettling());
  write("a.csv", "1");
  EXPECT_EQ(take(5000), Names{});
  EXPECT_EQ(take(6000), Names{"a.csv"});
}

}  // namespace
}  // namespace twinmap
