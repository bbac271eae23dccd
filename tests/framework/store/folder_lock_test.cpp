#include "framework/base/files/folder_lock.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <stdexcept>

#include "tests/framework/test_folder.hpp"

namespace twinmap {
namespace {

// Two processes: tests/framework/study/samples/interrupted_simulation_test.py.
TEST(FolderLock, RefusesASecondOwnerAndNamesTheFirst) {
  const TestFolder folder;
  const FolderLock first(folder.getPath());
  try {
    const FolderLock second(folder.getPath());
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(error.what(), folder.getPath().string() + ": is in use by process " +
                                std::to_string(::getpid()) +
                                "; wait until it has ended, or give another folder");
  }
}

TEST(FolderLock, EndsWithItsOwnerAndLeavesAnEmptyFile) {
  const TestFolder folder;
  for (int i = 0; i < 2; ++i) {
    const FolderLock lock(folder.getPath());
    EXPECT_EQ(readFile(folder / "lock"), std::to_string(::getpid()));
  }
  EXPECT_EQ(readFile(folder / "lock"), "");
}

TEST(FolderLock, ARefusedOwnerLeavesTheFirstItsLock) {
  const TestFolder folder;
  const FolderLock first(folder.getPath());
  EXPECT_THROW(FolderLock(folder.getPath()), std::runtime_error);
  EXPECT_THROW(FolderLock(folder.getPath()), std::runtime_error);
}

TEST(FolderLock, NamesAFolderThatIsNotThere) {
  const TestFolder folder;
  try {
    const FolderLock lock(folder / "no");
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("no/lock: cannot be opened: No such file"), std::string::npos);
  }
}

}  // namespace
}  // namespace twinmap
