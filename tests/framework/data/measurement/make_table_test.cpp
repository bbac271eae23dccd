#include "framework/data/measurement/files/make_table.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace twinmap {
namespace {

using Eigen::VectorXd;

const VectorXd kTimes = (VectorXd(3) << 0.0, 0.1, 0.2).finished();
const VectorXd kValues = (VectorXd(3) << 4.0, 5.0, 6.0).finished();

void expectError(const std::vector<NamedColumn>& columns, const std::vector<std::string>& wanted,
                 const std::string& text) {
  try {
    makeTable("rig", columns, wanted);
    FAIL() << "accepted";
  } catch (const MeasurementError& error) {
    EXPECT_NE(std::string(error.what()).find(text), std::string::npos) << error.what();
  }
}

TEST(MakeTable, ColumnsAreThoseOfAFileWithTheSameHeader) {
  const Table table = makeTable("rig", {{"t [ms]", kTimes}, {"enc1", kValues}});
  ASSERT_EQ(table.columns.size(), 2U);
  EXPECT_EQ(table.source, "rig");
  EXPECT_EQ(table.columns[0].name, "t");
  EXPECT_EQ(table.columns[0].unit, "ms");
  EXPECT_EQ(table.columns[1].unit, std::nullopt);
  EXPECT_EQ(table.columns[1].values, kValues);
}

TEST(MakeTable, KeepsWhatIsWanted) {
  const Table table = makeTable("rig", {{"t", kTimes}, {"other", kValues}}, {"t", "enc1"});
  ASSERT_EQ(table.columns.size(), 1U);
  EXPECT_EQ(table.columns[0].name, "t");
}

TEST(MakeTable, RefusesWhatNoFileCouldHold) {
  VectorXd holed = kValues;
  holed[1] = std::numeric_limits<double>::quiet_NaN();
  expectError({{"t", kTimes}, {"t [ms]", kTimes}}, {}, "rig: names the column 't' twice");
  expectError({{"enc1", holed}}, {"enc1"}, "column 'enc1' has nan at row 2");
  expectError({{"enc1", VectorXd(0)}}, {"enc1"}, "column 'enc1' has no samples");
}

}  // namespace
}  // namespace twinmap
