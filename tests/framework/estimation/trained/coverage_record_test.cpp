#include <gtest/gtest.h>

#include "framework/estimation/trained/test_records.hpp"

namespace twinmap {
namespace {

bool isShort(Eigen::Index tested, double one, double other) {
  return CoverageRecord{tested, Eigen::Vector2d(one, other)}.isShort();
}

TEST(CoverageRecord, IsShortWhereChanceDoesNotExplainIt) {
  EXPECT_TRUE(isShort(100, 0.95, 0.53));
  EXPECT_TRUE(isShort(50, 0.80, 0.96));  // 10 of 50 where 2.5 are expected: once in 10000
  EXPECT_FALSE(isShort(50, 0.88, 0.96));
  EXPECT_TRUE(isShort(2000, 0.91, 0.95));
}

TEST(CoverageRecord, IsNotShortByLittleHoweverSure) {
  EXPECT_FALSE(isShort(100000, 0.925, 0.95));
}

TEST(CoverageRecord, IsNotShortWhereNobodyLooked) {
  EXPECT_FALSE(CoverageRecord{}.isShort());
}

}  // namespace
}  // namespace twinmap
