#include "framework/study/sweep/sweep_tables.hpp"

#include <cmath>

#include "framework/base/files/atomic_file.hpp"
#include "framework/base/text/csv.hpp"
#include "framework/study/sweep/sweep_folder.hpp"
#include "tests/framework/test_folder.hpp"

namespace twinmap {
namespace {

SweepCase makeCase(const std::string& name, const std::vector<std::string>& values) {
  SweepCase one;
  one.name = name;
  one.values = values;
  return one;
}

/// Two noise levels with three seeds and one; a fifth case is not complete.
class SweepTables : public ::testing::Test {
 protected:
  SweepTables() {
    write(0, "parameter,unit,bias_pct,bias_pct_se,test_samples\nk,N/m,1,9,50\nc,,5,9,50\n");
    write(1, "parameter,unit,bias_pct,bias_pct_se,test_samples\nk,N/m,2,9,50\nc,,5,9,50\n");
    write(2, "parameter,unit,bias_pct,bias_pct_se,test_samples\nk,N/m,6,9,50\nc,,5,9,50\n");
    write(3, "parameter,unit,bias_pct,bias_pct_se,test_samples,limit_pct\nk,N/m,8,9,50,3\nc,,0,9,50,4\n");
    text_ = writeSweepTables(folder_.getPath(), {"noise.scale", "seed"}, cases_, complete_);
  }

  void write(std::size_t i, const std::string& text) const {
    makeFolders(getCaseFolder(folder_.getPath(), cases_[i]));
    writeTextFile(getCaseFolder(folder_.getPath(), cases_[i]) / "metrics.csv", text);
  }

  TestFolder folder_;
  std::vector<SweepCase> cases_{makeCase("a", {"1", "1"}), makeCase("b", {"1", "2"}),
                                makeCase("c", {"1", "3"}), makeCase("d", {"2", "1"}),
                                makeCase("e", {"2", "2"})};
  std::vector<bool> complete_{true, true, true, true, false};
  std::string text_;
};

TEST_F(SweepTables, HaveARowOfEachCaseAndParameter) {
  const CsvTable sweep = readCsvFile(folder_ / "sweep.csv");
  ASSERT_EQ(sweep.rows.size(), 8U);
  EXPECT_EQ(sweep.columns,
            (std::vector<std::string>{"case", "noise.scale", "seed", "parameter", "unit", "bias_pct",
                                      "bias_pct_se", "test_samples", "limit_pct"}));
  EXPECT_EQ(sweep.getText(2, "case"), "b");
  EXPECT_EQ(sweep.getText(2, "seed"), "2");
  EXPECT_EQ(sweep.getText(2, "bias_pct"), "2");
  EXPECT_EQ(sweep.getText(2, "limit_pct"), "");
  EXPECT_EQ(sweep.getText(7, "limit_pct"), "4");
}

TEST_F(SweepTables, SummariseOverTheSeedsAlone) {
  const CsvTable summary = readCsvFile(folder_ / "summary.csv");
  EXPECT_EQ(summary.columns,
            (std::vector<std::string>{"noise.scale", "parameter", "unit", "cases", "bias_pct", "bias_pct_se",
                                      "limit_pct", "limit_pct_se"}));
  ASSERT_EQ(summary.rows.size(), 4U);
  EXPECT_EQ(summary.getText(0, "cases"), "3");
  EXPECT_NEAR(summary.getNumber(0, "bias_pct"), 3.0, 1e-12);
  EXPECT_NEAR(summary.getNumber(0, "bias_pct_se"), std::sqrt(7.0 / 3.0), 1e-12);  // of 1, 2 and 6
  EXPECT_EQ(summary.getText(0, "limit_pct"), "");
  EXPECT_EQ(summary.getNumber(1, "bias_pct_se"), 0.0);
  EXPECT_EQ(summary.getText(2, "noise.scale"), "2");
  EXPECT_EQ(summary.getText(2, "cases"), "1");
  EXPECT_EQ(summary.getText(2, "bias_pct_se"), "");  // one seed has no spread
  EXPECT_EQ(summary.getNumber(3, "limit_pct"), 4.0);
}

TEST_F(SweepTables, AreReturnedAsTheyAreWritten) {
  EXPECT_EQ(readFile(folder_ / "table.md"), text_);
  EXPECT_NE(text_.find("differ in their seed alone"), std::string::npos);
}

TEST_F(SweepTables, RefuseADamagedCase) {
  write(1, "parameter,unit,bias_pct\nk,N/m\n");
  EXPECT_THROW(writeSweepTables(folder_.getPath(), {"noise.scale", "seed"}, cases_, complete_),
               std::runtime_error);
}

}  // namespace
}  // namespace twinmap
