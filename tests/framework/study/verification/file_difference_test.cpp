#include "framework/study/verification/file_difference.hpp"

#include <gtest/gtest.h>

namespace twinmap {
namespace {

TEST(FileDifference, OfACsvIsTheFirstCell) {
  EXPECT_EQ(findCsvDifference("a,b\n1,2\n3,4\n", "a,b\n1,2\n3,4\n"), "");
  EXPECT_EQ(findCsvDifference("a,b\n1,2\n3,5\n", "a,b\n1,2\n3,4\n"), "line 3, b: '5' instead of '4'");
  EXPECT_EQ(findCsvDifference("a,b\n1,2\n", "a,b\n1,2\n3,4\n"), "rows: '1' instead of '2'");
  EXPECT_EQ(findCsvDifference("a,c\n1,2\n", "a,b\n1,2\n"), "line 1: 'a,c' instead of 'a,b'");
  EXPECT_EQ(findCsvDifference("a,b\n1,\"2\"\n", "a,b\n1,2\n"), "bytes outside of the cells");
}

TEST(FileDifference, WallTimesMayDiffer) {
  const std::string expected = "a,seconds_per_update\n1,0.25\n";
  EXPECT_EQ(findCsvDifference("a,seconds_per_update\n1,0.75\n", expected), "");
  EXPECT_EQ(findCsvDifference("a,seconds_per_update\n2,0.25\n", expected), "line 2, a: '2' instead of '1'");
}

TEST(FileDifference, OfATextIsTheFirstLine) {
  EXPECT_EQ(findTextDifference("x\ny\n", "x\ny\n"), "");
  EXPECT_EQ(findTextDifference("x\nz\n", "x\ny\n"), "line 2: 'z' instead of 'y'");
  EXPECT_EQ(findTextDifference("x\n", "x\ny\n"), "line 2: '' instead of 'y'");
  EXPECT_EQ(findTextDifference("x", "x\n"), "bytes at its end");
}

}  // namespace
}  // namespace twinmap
