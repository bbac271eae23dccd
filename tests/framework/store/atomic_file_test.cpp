#include "framework/base/files/atomic_file.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "tests/framework/test_folder.hpp"

namespace twinmap {
namespace {

TEST(AtomicFile, WritesAndReplaces) {
  const TestFolder folder;
  writeTextFile(folder / "a.txt", "one");
  writeTextFile(folder / "a.txt", "two");
  EXPECT_EQ(readFile(folder / "a.txt"), "two");
  EXPECT_FALSE(std::filesystem::exists(getTemporaryPath(folder / "a.txt")));
}

TEST(AtomicFile, AFailureLeavesTheOldFileAndNoOther) {
  const TestFolder folder;
  writeTextFile(folder / "a.txt", "one");
  EXPECT_THROW(writeAtomically(folder / "a.txt",
                               [](const std::filesystem::path& temporary) {
                                 std::ofstream(temporary) << "half";
                                 throw std::runtime_error("disk full");
                               }),
               std::runtime_error);
  EXPECT_EQ(readFile(folder / "a.txt"), "one");
  EXPECT_FALSE(std::filesystem::exists(getTemporaryPath(folder / "a.txt")));
}

TEST(AtomicFile, NamesTheFileThatCannotBeWritten) {
  const TestFolder folder;
  try {
    writeTextFile(folder / "no/such/folder.txt", "x");
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("no/such/folder.txt"), std::string::npos);
  }
}

// Every write to /dev/full fails as on a full disk.
TEST(AtomicFile, AFullDiskIsNamedAndLeavesTheOldFile) {
  const TestFolder folder;
  writeTextFile(folder / "a.txt", "one");
  std::filesystem::create_symlink("/dev/full", getTemporaryPath(folder / "a.txt"));
  try {
    writeTextFile(folder / "a.txt", "two");
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(error.what(),
              (getTemporaryPath(folder / "a.txt")).string() + ": cannot be written: No space left on device");
  }
  EXPECT_EQ(readFile(folder / "a.txt"), "one");
  EXPECT_FALSE(std::filesystem::is_symlink(getTemporaryPath(folder / "a.txt")));
}

TEST(AtomicFile, MakesFoldersOnceAndReadsFilesWhole) {
  const TestFolder folder;
  makeFolders(folder / "a/b/c/");
  makeFolders(folder / "a/b/c");
  const std::string bytes("zero \0 and more", 15);
  writeTextFile(folder / "a/b/c/x", bytes);
  EXPECT_EQ(readBytes(folder / "a/b/c/x"), bytes);
  writeTextFile(folder / "empty", "");
  EXPECT_EQ(readBytes(folder / "empty"), "");
  EXPECT_THROW(readBytes(folder / "none"), std::runtime_error);
}

}  // namespace
}  // namespace twinmap
