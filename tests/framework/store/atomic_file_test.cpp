#include "framework/store/atomic_file.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "tests/framework/temporary_folder.hpp"

namespace twinmap {
namespace {

TEST(AtomicFile, WritesAndReplaces) {
  const TemporaryFolder folder;
  writeTextFile(folder / "a.txt", "one");
  writeTextFile(folder / "a.txt", "two");
  EXPECT_EQ(readFile(folder / "a.txt"), "two");
  EXPECT_FALSE(std::filesystem::exists(folder / "a.txt.tmp"));
}

TEST(AtomicFile, AFailureLeavesTheOldFileAndNoOther) {
  const TemporaryFolder folder;
  writeTextFile(folder / "a.txt", "one");
  EXPECT_THROW(writeAtomically(folder / "a.txt",
                               [](const std::filesystem::path& temporary) {
                                 std::ofstream(temporary) << "half";
                                 throw std::runtime_error("disk full");
                               }),
               std::runtime_error);
  EXPECT_EQ(readFile(folder / "a.txt"), "one");
  EXPECT_FALSE(std::filesystem::exists(folder / "a.txt.tmp"));
}

TEST(AtomicFile, NamesTheFileThatCannotBeWritten) {
  const TemporaryFolder folder;
  try {
    writeTextFile(folder / "no/such/folder.txt", "x");
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("no/such/folder.txt"), std::string::npos);
  }
}

}  // namespace
}  // namespace twinmap
